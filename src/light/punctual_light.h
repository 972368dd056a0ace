// Lights without extent: point, spot and directional (glTF's KHR_lights_punctual). All are deltas: no ray hits them.
#pragma once

#include "light/light_sample.h"

namespace etendue {

/// Radiates equally in all directions from a point.
struct PointLight {
    Vec3f position{0.0f};
    Rgb intensity{1.0f};  ///< W/sr

    [[nodiscard]] LightSample sample(const Vec3f& point, Vec2f u) const;
    [[nodiscard]] float power(float scene_radius) const;
};

/// A point that radiates into a cone. Between the two cones intensity falls off as KHR_lights_punctual recommends: the
/// square of a linear ramp in the cosine.
struct SpotLight {
    Vec3f position{0.0f};
    Vec3f axis{0.0f, 0.0f, -1.0f};  ///< unit, the direction it shines in
    Rgb intensity{1.0f};            ///< W/sr inside the inner cone
    float cos_inner = 1.0f;
    float cos_outer = 0.7f;  ///< <= cos_inner; a hard edge if they are equal

    [[nodiscard]] float falloff(float cos_angle) const;
    [[nodiscard]] LightSample sample(const Vec3f& point, Vec2f u) const;
    [[nodiscard]] float power(float scene_radius) const;
};

/// Parallel light from infinitely far away.
struct DirectionalLight {
    Vec3f direction{0.0f, 0.0f, -1.0f};  ///< unit, the direction it shines in
    Rgb irradiance{1.0f};                ///< W/m² on a surface that faces it

    [[nodiscard]] LightSample sample(const Vec3f& point, Vec2f u) const;
    [[nodiscard]] float power(float scene_radius) const;
};

}  // namespace etendue
