// What every light answers when asked for light at a point.
#pragma once

#include "core/rgb.h"
#include "core/vec.h"

#include <cstdint>
#include <limits>

namespace etendue {

struct LightSample {
    Vec3f wi{0.0f};  ///< unit, from the lit point towards the light
    /// Holds metres to the light; infinite for directional and environment light.
    float distance = std::numeric_limits<float>::infinity();
    Vec3f end{0.0f};  ///< where a shadow ray ends, clear of the light's own surface; not meaningful at infinity
    /// Radiance that arrives along wi if nothing is in the way. For a delta light the irradiance on a surface facing it
    /// (point: I/d²; directional: E), which takes the place of radiance over pdf.
    Rgb radiance;
    /// Holds the density of wi, 1/sr, without the choice of the light; not meaningful if `is_delta`.
    float pdf_solid_angle = 0.0f;
    bool is_delta = false;
    float cos_light = 1.0f;         ///< mesh and shape lights: between -wi and the normal of the front
    std::uint32_t triangle = 0;     ///< mesh lights: which triangle was chosen; of a shape the face (shape/shape.h)
    Vec2f barycentric{0.0f, 0.0f};  ///< mesh lights: of the second and third vertex; of a shape the place
};

}  // namespace etendue
