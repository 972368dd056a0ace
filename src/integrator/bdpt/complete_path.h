// A path from a light to the lens, as a strategy of bidirectional path tracing has made it.
#pragma once

#include "wave/subpath/subpath_wave.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace etendue {

/// Describes the first vertex of a path, on its light.
struct PathLightEnd {
    std::uint32_t light = kNone;      ///< kNone if it is not sampled
    std::uint32_t triangle = 0;       ///< of a mesh light
    Vec3f position{0.0f};             ///< not meaningful at infinity
    Vec3f direction{0.0f};            ///< unit, towards the second vertex
    float cos_light = 1.0f;           ///< between the direction and the normal of a mesh light's front
    bool is_reached_directly = true;  ///< by an eye subpath, if that made the whole path
};

/// Describes a path that the strategy with `s` vertices from the light has made.
struct CompletePath {
    PathLightEnd end;
    std::span<const PathVertex* const> inner;  ///< from the light to the lens, without the vertices there; not empty
    std::size_t s = 0;
    CameraConnection camera;  ///< how the camera sees the last of `inner`
};

}  // namespace etendue
