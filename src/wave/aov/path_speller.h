// Paths spelled out in the letters of light path expressions, for a few that somebody wants to know more about.
//
// In place of the automaton's states, which know no more than which expressions a path may belong to, the words of
// paths are kept event by event. That is for single samples: nothing is forgotten before `clear`.
#pragma once

#include "core/rgb.h"
#include "core/vec.h"
#include "lightpath/path_event.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace etendue {

/// How light comes to the eye.
enum class LightKind : std::uint8_t {
    Seen,    ///< the eye sees its source: C L
    Direct,  ///< mirrors and smooth glass apart, the eye sees what it lights without another bounce: C S* . L and C S+
             ///< L
    Indirect,  ///< all other
};

/// Returns the kind of the light that a path from the eye has met. `is_seen` is true if the eye sees the light itself,
/// `is_direct` if all vertices but the last were deltas.
[[nodiscard]] constexpr LightKind kind_of_met_light(bool is_seen, bool is_direct) {
    if (is_seen) return LightKind::Seen;
    return is_direct ? LightKind::Direct : LightKind::Indirect;
}

/// A path by the events that it consists of.
struct SpelledPath {
    /// Spells the path from the eye to the light, such as "C D S S O", as an expression that matches it. A vertex that
    /// may be taken for several events is the one that scatters most.
    std::string word;
    int s = 0;  ///< vertices from the light, as in `Strategy`
    int t = 0;  ///< vertices from the eye
    int edges = 0;
};

/// Holds what a path has brought to its sample, or to the film as a splat.
struct SpelledContribution {
    std::optional<SpelledPath> path;  ///< none of integrators that do not tell paths apart
    Rgb value;                        ///< before any limit; of a splat, as a sample of the pixel has it
    std::optional<Vec2f> position;    ///< place of a splat, pixels of the full image
    LightKind kind = LightKind::Direct;
};

class PathSpeller {
  public:
    using Node = std::uint32_t;
    static constexpr Node kEye = std::numeric_limits<Node>::max();

    void clear();

    [[nodiscard]] Node begin_at_light(SourceEvent source);
    [[nodiscard]] Node scatter(Node before, ScatterEvent event);

    /// Returns the number of the path that the subpath from the eye, which ends in `eye`, makes with a light of kind
    /// `source`.
    [[nodiscard]] std::size_t meet_light(Node eye, SourceEvent source, bool is_sampled);
    [[nodiscard]] std::size_t meet_camera(Node light);
    [[nodiscard]] std::size_t connect(Node eye, Node light);

    void record(const SpelledContribution& contribution) { contributions_.push_back(contribution); }
    [[nodiscard]] const SpelledPath& path(std::size_t number) const { return paths_[number]; }
    [[nodiscard]] std::span<const SpelledContribution> contributions() const { return contributions_; }

  private:
    struct Event {
        Node before = kEye;
        char letter = ' ';
    };
    [[nodiscard]] Node append(Node before, char letter);
    /// Returns the letters of the subpath that ends in `node`, from its beginning.
    [[nodiscard]] std::string letters(Node node) const;
    [[nodiscard]] std::size_t keep(const std::string& letters, std::size_t s, std::size_t t);

    std::vector<Event> events_;
    std::vector<SpelledPath> paths_;
    std::vector<SpelledContribution> contributions_;
};

}  // namespace etendue
