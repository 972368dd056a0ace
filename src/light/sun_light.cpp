#include "light/sun_light.h"

#include "core/frame.h"
#include "light/punctual_light.h"
#include "sampling/warp.h"

#include <algorithm>
#include <cmath>

namespace etendue {

namespace {

/// Returns one minus the cosine of half of `angle`: the height of the sun's disk as a cap of the unit sphere. Angles
/// below 1e-5 count as 1e-5, so that the disk has directions in single precision.
float cap_height(float angle) {
    constexpr float kSmallest = 1e-5f;
    const float sine = std::sin(0.25f * std::max(angle, kSmallest));
    return 2.0f * sine * sine;
}

}  // namespace

SunLight::SunLight(const Vec3f& direction, const Rgb& irradiance, float angle)
    : direction_(direction),
      height_(cap_height(angle)),
      pdf_(0.5f * kInvPi / height_),
      // The mean cosine to the middle, over a cap of the sphere, is (1 + cosine at its edge) / 2.
      radiance_(irradiance * (2.0f / (2.0f - height_) * pdf_)) {}

Rgb SunLight::radiance(const Vec3f& direction) const {
    return pdf_solid_angle(direction) > 0.0f ? radiance_ : Rgb();
}

float SunLight::pdf_solid_angle(const Vec3f& direction) const {
    // By the chord: in single precision, the cosine of a small angle is that of others, too.
    return length_squared(direction + direction_) <= 2.0f * height_ ? pdf_ : 0.0f;
}

Vec3f SunLight::sample_direction(Vec2f u) const {
    return normalize(Frame::from_normal(direction_).to_world(square_to_spherical_cap(u, height_)));
}

LightSample SunLight::sample(const Vec3f&, Vec2f u) const {
    LightSample sample;
    sample.wi = -sample_direction(u);
    sample.radiance = radiance_;
    sample.pdf_solid_angle = pdf_;
    return sample;
}

EmissionSample SunLight::sample_emission(const EmissionNumbers& u, const SceneSphere& scene) const {
    EmissionSample sample = sample_emission_from_afar(sample_direction(u.direction), scene, u.position);
    sample.radiance = radiance_;
    sample.pdf_direction_solid_angle = pdf_;
    return sample;
}

float SunLight::emission_pdf(const Vec3f&, float, const SceneSphere& scene) const {
    return emission_from_afar_pdf_area(scene);
}

float SunLight::power(float scene_radius) const {
    return kPi * scene_radius * scene_radius * average(radiance_) / pdf_;
}

}  // namespace etendue
