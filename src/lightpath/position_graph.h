// The places of expressions at which an event can stand, and which can follow which: an automaton without empty moves
// (Glushkov, "The Abstract Theory of Automata", 1961).
#pragma once

#include "lightpath/expression.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// Most positions of all expressions together.
inline constexpr std::size_t kMostPositions = 1024;

/// The positions of several expressions, read from the eye to the light. Each expression begins with a position of its
/// own that no event stands at.
struct PositionGraph {
    struct Position {
        const EventSet* event = nullptr;  ///< null at a beginning
        std::size_t expression = 0;
        std::vector<std::size_t> following;  ///< in ascending order, each once
        bool may_end = false;                ///< a path may end here
    };
    std::vector<Position> positions;
    std::vector<std::size_t> beginnings;  ///< the position at which each expression begins
};

/// `expressions` must outlive the graph. Throws ExpressionError (with offset 0) if an expression neither begins with
/// the camera and ends at a light nor the other way round, or if all have more than kMostPositions.
[[nodiscard]] PositionGraph make_position_graph(std::span<const PathExpression> expressions);

}  // namespace etendue
