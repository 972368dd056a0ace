// Light path expressions: regular expressions over the events of light paths.
//
//   C E            the camera (Heckbert's eye)
//   L O B          any light; a surface that emits; the environment
//   D G S          a diffuse, glossy or singular scattering
//   R T V          a reflection, a transmission, a scattering in a medium
//   .              any event
//   <RD'gold'>     a reflection (T, V, or . for any) that is diffuse (G, S, or . for any), on a material named gold
//   <L'key'>       a light named key (O, B for those only); in names, * stands for any characters
//   [DG] [^S]      one of these, any event but these
//   x* x+ x? x{2} x{1,3} x{2,}   repetitions; (x), x|y groups and choices; spaces mean nothing
//   !x             at the beginning: every path that x does not match
//
// An expression matches whole paths. It begins with the camera and ends at a light, or the other way round.
#pragma once

#include "lightpath/path_event.h"

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

/// Says what is wrong with an expression, and where.
class ExpressionError : public std::runtime_error {
  public:
    /// `offset` in characters from the beginning of the expression.
    ExpressionError(const std::string& what, std::size_t offset) : std::runtime_error(what), offset_(offset) {}
    [[nodiscard]] std::size_t offset() const { return offset_; }

  private:
    std::size_t offset_;
};

/// Events of some kinds, on or of what has a name that matches.
struct EventPattern {
    EventKinds kinds = 0;
    std::string label;  ///< empty: of any name
};

/// One event out of a set.
struct EventSet {
    std::vector<EventPattern> patterns;
    bool is_negated = false;  ///< any event but these
};

/// A part of an expression, with its children by their indices in PathExpression::nodes.
struct ExpressionNode {
    enum class Kind { Event, Sequence, Choice, Repeat };
    static constexpr int kEndless = -1;

    Kind kind = Kind::Sequence;
    EventSet event{};
    std::vector<std::size_t> children{};
    int least = 1;  ///< repetitions
    int most = 1;   ///< kEndless for any number
};

/// An expression as it was parsed, children before their parents: the last node is the whole.
struct PathExpression {
    std::vector<ExpressionNode> nodes;
    bool is_negated = false;
};

/// Most of the repetitions that an expression can count.
inline constexpr int kMostRepetitions = 64;

/// Throws ExpressionError.
[[nodiscard]] PathExpression parse_expression(std::string_view text);

}  // namespace etendue
