// A sun: parallel light from a disk of directions, infinitely far away.
//
// Rays that leave the scene within the disk meet its radiance, and light samples pick directions there uniformly.
#pragma once

#include "light/emission_sample.h"
#include "light/light_sample.h"

#include <cstddef>
#include <optional>

namespace etendue {

/// Shines from within `angle` / 2 of one direction, evenly, as a disk does that is seen under this angle.
class SunLight {
  public:
    /// `direction` is the unit one that it shines in; `irradiance`, W/m², that of a surface that faces it, and the same
    /// for every `angle`, radians, (0, pi).
    SunLight(const Vec3f& direction, const Rgb& irradiance, float angle);

    /// Returns the radiance that a ray along `direction` meets, zero beside the disk.
    [[nodiscard]] Rgb radiance(const Vec3f& direction) const;
    /// Returns the density with which `sample` and `sample_emission` pick `direction`, 1/sr, towards the sun.
    [[nodiscard]] float pdf_solid_angle(const Vec3f& direction) const;
    [[nodiscard]] LightSample sample(const Vec3f& point, Vec2f u) const;
    [[nodiscard]] EmissionSample sample_emission(const EmissionNumbers& u, const SceneSphere& scene) const;
    [[nodiscard]] float emission_pdf(const Vec3f& direction, float cos_light, const SceneSphere& scene) const;
    [[nodiscard]] float power(float scene_radius) const;
    [[nodiscard]] static std::optional<Vec3f> point() { return std::nullopt; }
    [[nodiscard]] static constexpr std::size_t bytes() { return 0; }
    [[nodiscard]] static constexpr bool is_delta() { return false; }
    [[nodiscard]] static constexpr bool is_at_infinity() { return true; }
    [[nodiscard]] static constexpr bool is_environment() { return false; }

  private:
    /// Returns a direction that light goes in.
    [[nodiscard]] Vec3f sample_direction(Vec2f u) const;

    Vec3f direction_;
    float height_;  ///< height of the disk as a cap of the unit sphere: one minus the cosine of half the angle
    float pdf_;     ///< 1/sr, of each direction within the disk
    Rgb radiance_;  ///< W/(m² sr)
};

}  // namespace etendue
