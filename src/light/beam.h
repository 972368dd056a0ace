// How the radiance of a lamp's surface depends on the angle to its normal: what makes a panel or a disk shine into a
// cone. Directions are chosen by the cosine within that cone, so that light subpaths waste none.
#pragma once

#include "core/vec.h"
#include "sampling/warp.h"

#include <cmath>
#include <cstdint>

namespace etendue {

/// Returns the share of a spot's intensity at an angle with the cosine `cos_angle` from its axis, as
/// KHR_lights_punctual recommends: the square of a linear ramp in the cosine between the two cones.
[[nodiscard]] float spot_falloff(float cos_angle, float cos_inner, float cos_outer);

/// Returns the integral of `spot_falloff` over all directions, steradians.
[[nodiscard]] float spot_solid_angle(float cos_inner, float cos_outer);

class Beam {
  public:
    /// Makes the beam of a diffuse surface: radiance is the same in all directions.
    Beam() = default;

    /// Makes the beam of a panel behind a grid of slats: light leaves at most `spread` / 2 from the normal, `spread`
    /// radians, (0, pi]. Its power is that of the diffuse surface, its radiance
    ///   (tan a - tan theta) / (tan a - a)   with a = spread / 2
    /// times as much (Blender's spread of area lamps, developer.blender.org/D10594).
    [[nodiscard]] static Beam panel(float spread);

    /// Makes the beam of a disk whose intensity is that of a spot with these cones, radians from the normal, as
    /// KHR_lights_punctual has them: radiance is falloff / cos theta times that of the disk along its normal.
    [[nodiscard]] static Beam spot(float inner, float outer);

    [[nodiscard]] bool is_diffuse() const { return kind_ == Kind::Diffuse; }

    /// Returns the factor of the radiance in a direction with the cosine `cosine` to the normal, > 0.
    [[nodiscard]] float factor(float cosine) const {
        if (kind_ == Kind::Diffuse) return 1.0f;
        return cosine > cos_outer_ ? shaped_factor(cosine) : 0.0f;
    }

    /// Returns the power of a surface over that of a diffuse one with the same radiance, without this factor.
    [[nodiscard]] float mean_factor() const { return mean_factor_; }

    /// Returns the half angle of the cone that light leaves into, radians.
    [[nodiscard]] float half_angle() const { return half_angle_; }

    /// Samples a direction around +z by its cosine, within the cone.
    [[nodiscard]] Vec3f sample(Vec2f u) const {
        if (kind_ == Kind::Diffuse) return square_to_cosine_hemisphere(u);
        const Vec2f d = square_to_disk(u) * sin_outer_;
        return {d.x, d.y, std::sqrt(std::fmax(0.0f, 1.0f - dot(Vec3f(d.x, d.y, 0.0f), Vec3f(d.x, d.y, 0.0f))))};
    }

    /// Returns the density of `sample`, 1/sr, over that of a diffuse surface.
    [[nodiscard]] float density_factor(float cosine) const {
        if (kind_ == Kind::Diffuse) return 1.0f;
        return cosine >= cos_outer_ ? 1.0f / (sin_outer_ * sin_outer_) : 0.0f;
    }

  private:
    enum class Kind : std::uint8_t { Diffuse, Panel, Spot };

    Beam(Kind kind, float half_angle);
    [[nodiscard]] float shaped_factor(float cosine) const;

    Kind kind_ = Kind::Diffuse;
    float half_angle_ = 0.5f * kPi;
    float cos_outer_ = 0.0f;
    float sin_outer_ = 1.0f;
    float cos_inner_ = 0.0f;  ///< cosine of a spot's inner angle
    float tan_outer_ = 0.0f;  ///< tangent of a panel's outer angle
    float scale_ = 1.0f;      ///< scale of a panel: 1 / (tan a - a)
    float mean_factor_ = 1.0f;
};

}  // namespace etendue
