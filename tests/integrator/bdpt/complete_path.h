// A path from a light to the lens, as a strategy of bidirectional path tracing has made it.
#pragma once

#include "transport/merging.h"
#include "transport/mis.h"
#include "transport/vertex.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace etendue::test {

/// Describes the first vertex of a path, on its light.
struct PathLightEnd {
    std::uint32_t light = kNone;      ///< kNone if it is not sampled
    std::uint32_t triangle = 0;       ///< of a mesh light
    Vec3f position{0.0f};             ///< not meaningful at infinity
    Vec3f direction{0.0f};            ///< unit, towards the second vertex
    float cos_light = 1.0f;           ///< between the direction and the normal of a mesh light's front
    bool is_reached_directly = true;  ///< by an eye subpath, if that made the whole path
    float time = 0.0f;                ///< when light leaves
};

/// Holds a vertex between the light and the lens, and how its subpath came to it and left it.
struct WalkedVertex : Vertex {
    int index = 1;                     ///< vertices of its subpath before it
    bool is_reached_directly = true;   ///< false if boundaries that other bodies hide lie before it
    bool is_left_by_delta = false;     ///< the subpath went on by one
    bool is_after_delta = false;       ///< the subpath has scattered by a delta, or passed a hidden boundary
    float delta_reverse_ratio = 1.0f;  ///< BsdfSample::reverse_ratio of the delta by which it was left
    SubpathDensities densities{};
    MergePlace merging{};

    [[nodiscard]] bool is_on_surface() const { return kind == Kind::Surface; }
};

/// Describes a path that the strategy with `s` vertices from the light has made.
struct CompletePath {
    PathLightEnd end;
    std::vector<const WalkedVertex*> inner;  ///< from the light to the lens, without the vertices there; not empty
    std::size_t s = 0;
    CameraConnection camera;  ///< how the camera sees the last of `inner`
};

}  // namespace etendue::test
