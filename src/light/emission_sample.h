// What every light answers when asked for a ray that leaves it: the beginning of a light subpath.
#pragma once

#include "core/rgb.h"
#include "core/vec.h"

#include <cstdint>

namespace etendue {

/// A sphere around all geometry, for lights at infinity: their rays start on a disk of its size.
struct SceneSphere {
    Vec3f center{0.0f};
    float radius = 1.0f;  ///< metres, > 0
};

/// The random numbers of a ray, each in [0, 1)².
struct EmissionNumbers {
    Vec2f triangle;  ///< numbers that choose the triangle of a mesh light or the face of a shape
    Vec2f position;
    Vec2f direction;
};

struct EmissionSample {
    Vec3f position{0.0f};   ///< where light starts, metres
    Vec3f offset{0.0f};     ///< offset that takes a ray along `direction` clear of the light's own surface
    Vec3f direction{0.0f};  ///< unit, away from the light
    /// Radiance along `direction`, W/(m² sr); of a point its intensity, W/sr; of a directional light its irradiance,
    /// W/m².
    Rgb radiance;
    /// Cosine between the direction and the normal of the light's surface; 1 for lights without one.
    float cos_theta = 1.0f;
    /// Is the density of the origin: on the surface, or on the disk across the direction for lights at infinity, 1/m²;
    /// 1 at a point.
    float pdf_position_area = 1.0f;
    float pdf_direction_solid_angle = 1.0f;  ///< 1/sr; 1 for directional lights
    std::uint32_t triangle = 0;              ///< mesh lights: which triangle was chosen; of a shape the face
    Vec2f barycentric{0.0f, 0.0f};           ///< mesh lights: of the second and third vertex; of a shape the place

    /// Where a ray starts that leaves along `towards`, which may be the other side of the surface.
    [[nodiscard]] Vec3f origin(const Vec3f& towards) const {
        return dot(towards, offset) >= 0.0f ? position + offset : position - offset;
    }
    /// Radiance and cosine over both densities: what the ray carries.
    [[nodiscard]] Rgb weight() const {
        return radiance * (cos_theta / (pdf_position_area * pdf_direction_solid_angle));
    }
};

}  // namespace etendue
