// How wide a ray is: the cone around it that stands for the light a sample stands for, from which textures are filtered
// (Akenine-Möller et al., "Texture Level of Detail Strategies for Real-Time Ray Tracing", Ray Tracing Gems 2019,
// chapter 20; and "Improved Shader and Texture Level of Detail Using Ray Cones", JCGT 10(1), 2021).
#pragma once

#include <algorithm>
#include <cmath>

namespace etendue {

/// Describes the cone around a ray; its width and its spread may be negative, as a concave mirror makes cones that
/// narrow, and widen again behind the point where they cross.
struct RayCone {
    float width = 0.0f;   ///< diameter at the ray's origin, metres
    float spread = 0.0f;  ///< by which the diameter grows per metre: the full angle, radians

    /// Returns the cone's diameter, with its sign, at distance `t` metres.
    [[nodiscard]] float width_at(float t) const { return width + spread * t; }
    /// Returns the cone from distance `t` metres on: as wide as this cone is there, with the same spread.
    [[nodiscard]] RayCone at(float t) const { return {width_at(t), spread}; }
};

/// Largest spread after a bounce, radians. Wider lobes are read as if they were this wide: filtering is there against
/// aliasing, and what it blurs must stay small beside what the lobe blurs itself.
inline constexpr float kMaxConeSpread = 0.2f;

/// The part of a lobe, by solid angle, that one sample is taken to stand for: less than all of it, as the samples of a
/// pixel share the lobe between them.
inline constexpr float kConeLobeShare = 1.0f / 64.0f;

/// False where a lobe spreads by kMaxConeSpread around a direction sampled with `pdf_solid_angle` (1/sr), as it does
/// where that is zero.
[[nodiscard]] inline bool is_narrow_lobe(float pdf_solid_angle) {
    return pdf_solid_angle * (kMaxConeSpread * kMaxConeSpread) > kConeLobeShare;
}

/// Spread, radians, of a cone as large as the share of a lobe around a direction sampled with `pdf_solid_angle` (1/sr).
[[nodiscard]] inline float lobe_spread(float pdf_solid_angle) {
    return is_narrow_lobe(pdf_solid_angle) ? std::sqrt(kConeLobeShare / pdf_solid_angle) : kMaxConeSpread;
}

/// The cone behind a surface of `curvature` (1/m, positive where it is convex towards the arriving ray), reflected in
/// paraxial approximation: a normal that turns by c turns the ray by 2c. `cone` is the one that arrives, its width the
/// one at the surface.
[[nodiscard]] inline RayCone reflect_cone(const RayCone& cone, float curvature) {
    return {cone.width, std::clamp(cone.spread + 2.0f * curvature * cone.width, -kMaxConeSpread, kMaxConeSpread)};
}

/// Returns the cone behind a surface of `curvature` (1/m, positive where it is convex towards the arriving ray),
/// refracted in paraxial approximation: the angle to the normal is divided by `eta`, the index behind the surface over
/// the one before it. `cone` is the one that arrives, its width the one at the surface.
[[nodiscard]] inline RayCone refract_cone(const RayCone& cone, float curvature, float eta) {
    const float tilt = curvature * cone.width;
    return {cone.width, std::clamp((cone.spread + tilt) / eta - tilt, -kMaxConeSpread, kMaxConeSpread)};
}

/// The cone after scattering into a direction around which the lobe spreads by `spread` radians (`lobe_spread`).
[[nodiscard]] inline RayCone scatter_cone(const RayCone& cone, float spread) {
    return {std::abs(cone.width), std::min(std::abs(cone.spread) + spread, kMaxConeSpread)};
}

}  // namespace etendue
