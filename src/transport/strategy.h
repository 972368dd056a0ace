// The ways in which bidirectional path tracing makes paths.
#pragma once

namespace etendue {

/// One way to make a path: `s` vertices from the light, `t` from the eye, those on the light and on the lens included.
/// Vertices in media count here, though they add no edge to a path's length.
struct Strategy {
    int s = 0;
    int t = 0;

    /// True if there is such a strategy: no light hits the lens (t = 0).
    [[nodiscard]] bool exists() const { return s >= 0 && t >= 1 && s + t >= 2; }
    [[nodiscard]] int edges() const { return s + t - 1; }
    friend bool operator==(const Strategy&, const Strategy&) = default;
};

/// Stands for all merges (transport/merging.h), which are no strategies of bidirectional path tracing.
inline constexpr Strategy kMerges{0, 0};

}  // namespace etendue
