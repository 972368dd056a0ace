// Lights without extent: point, spot and directional (glTF's KHR_lights_punctual). All are deltas: no ray hits them.
#pragma once

#include "light/beam.h"
#include "light/emission_sample.h"
#include "light/light_aim.h"
#include "light/light_bounds.h"
#include "light/light_sample.h"

#include <cstddef>
#include <cstdint>
#include <optional>

namespace etendue {

/// Radiates equally in all directions from a point.
struct PointLight {
    Vec3f position{0.0f};
    Rgb intensity{1.0f};  ///< W/sr

    [[nodiscard]] LightSample sample(const Vec3f& point, Vec2f u) const;
    [[nodiscard]] EmissionSample sample_emission(const EmissionNumbers& u, const SceneSphere& scene) const;
    [[nodiscard]] float emission_pdf(const Vec3f& direction, float cos_light, const SceneSphere& scene) const;
    [[nodiscard]] LightCone<float> cone(std::uint32_t) const;
    void turn(EmissionSample& sample, const Vec3f& direction) const;
    [[nodiscard]] float power(float scene_radius) const;
    [[nodiscard]] LightBounds bounds() const;
    [[nodiscard]] std::optional<Vec3f> point() const { return position; }
    [[nodiscard]] static constexpr std::size_t bytes() { return 0; }
    [[nodiscard]] static constexpr bool is_delta() { return true; }
    [[nodiscard]] static constexpr bool is_at_infinity() { return false; }
    [[nodiscard]] static constexpr bool is_environment() { return false; }
};

/// A point that radiates into a cone. Between the two cones intensity falls off as KHR_lights_punctual recommends: the
/// square of a linear ramp in the cosine.
struct SpotLight {
    Vec3f position{0.0f};
    Vec3f axis{0.0f, 0.0f, -1.0f};  ///< unit, the direction it shines in
    Rgb intensity{1.0f};            ///< W/sr inside the inner cone
    float cos_inner = 1.0f;
    float cos_outer = 0.7f;  ///< <= cos_inner; a hard edge if they are equal

    [[nodiscard]] float falloff(float cos_angle) const { return spot_falloff(cos_angle, cos_inner, cos_outer); }
    [[nodiscard]] LightSample sample(const Vec3f& point, Vec2f u) const;
    [[nodiscard]] EmissionSample sample_emission(const EmissionNumbers& u, const SceneSphere& scene) const;
    [[nodiscard]] float emission_pdf(const Vec3f& direction, float cos_light, const SceneSphere& scene) const;
    [[nodiscard]] LightCone<float> cone(std::uint32_t) const;
    void turn(EmissionSample& sample, const Vec3f& direction) const;
    [[nodiscard]] float power(float scene_radius) const;
    [[nodiscard]] LightBounds bounds() const;
    [[nodiscard]] std::optional<Vec3f> point() const { return position; }
    [[nodiscard]] static constexpr std::size_t bytes() { return 0; }
    [[nodiscard]] static constexpr bool is_delta() { return true; }
    [[nodiscard]] static constexpr bool is_at_infinity() { return false; }
    [[nodiscard]] static constexpr bool is_environment() { return false; }
};

/// Parallel light from infinitely far away.
struct DirectionalLight {
    Vec3f direction{0.0f, 0.0f, -1.0f};  ///< unit, the direction it shines in
    Rgb irradiance{1.0f};                ///< W/m² on a surface that faces it

    [[nodiscard]] LightSample sample(const Vec3f& point, Vec2f u) const;
    [[nodiscard]] EmissionSample sample_emission(const EmissionNumbers& u, const SceneSphere& scene) const;
    [[nodiscard]] float emission_pdf(const Vec3f& direction, float cos_light, const SceneSphere& scene) const;
    [[nodiscard]] float power(float scene_radius) const;
    [[nodiscard]] static std::optional<Vec3f> point() { return std::nullopt; }
    [[nodiscard]] static constexpr std::size_t bytes() { return 0; }
    [[nodiscard]] static constexpr bool is_delta() { return true; }
    [[nodiscard]] static constexpr bool is_at_infinity() { return true; }
    [[nodiscard]] static constexpr bool is_environment() { return false; }
};

/// Returns the bounds of a light at `position` that shines as `cone` and `power` say.
[[nodiscard]] LightBounds bounds_of_point(const Vec3f& position, const EmissionCone& cone, float power);

/// Samples what all lights at a point share of an emission: a direction within the cone around the unit `axis` whose
/// half angle has the cosine `cos_max`, uniformly; without the radiance.
[[nodiscard]] EmissionSample sample_emission_in_cone(const Vec3f& position, const Vec3f& axis, float cos_max, Vec2f u);

/// Returns the density with which `sample_emission_in_cone` picks `direction`, 1/sr.
[[nodiscard]] float emission_in_cone_pdf_solid_angle(const Vec3f& direction, const Vec3f& axis, float cos_max);

/// Samples what all lights in one direction, infinitely far away, share of an emission: a point on a disk as large as
/// the scene, across the unit `direction` in which light goes.
[[nodiscard]] EmissionSample sample_emission_from_afar(const Vec3f& direction, const SceneSphere& scene, Vec2f u);

/// Returns the density with which `sample_emission_from_afar` picks a point, 1/m² across the direction.
[[nodiscard]] float emission_from_afar_pdf_area(const SceneSphere& scene);

}  // namespace etendue
