// The weights of all strategies of a given path, from their definition: every density of every vertex computed anew
// (Veach 1997, section 10.2). Slow; what the recursion of transport/mis.h must say, too.
#pragma once

#include "integrator/subpath/subpath_wave.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// The first vertex of a path.
struct PathLightEnd {
    std::uint32_t light = kNone;      ///< kNone if it is not sampled
    std::uint32_t triangle = 0;       ///< of a mesh light
    Vec3f position{0.0f};             ///< not meaningful at infinity
    Vec3f direction{0.0f};            ///< unit, towards the second vertex
    float cos_light = 1.0f;           ///< between the direction and the normal of a mesh light's front
    bool is_reached_directly = true;  ///< by an eye subpath, if that made the whole path
};

/// A path that the strategy with `s` vertices from the light has made.
struct CompletePath {
    PathLightEnd end;
    std::span<const PathVertex* const> inner;  ///< from the light to the lens, without the vertices there; not empty
    std::size_t s = 0;
    CameraConnection camera;  ///< how the camera sees the last of `inner`
};

/// Element i is the weight of the strategy with i vertices from the light; the last is that of t = 1.
[[nodiscard]] std::vector<double> reference_weights(const SubpathJob& job, const CompletePath& path);

}  // namespace etendue
