#include "light/punctual_light.h"

namespace etendue {

namespace {

/// Shared by the lights that sit at a point.
LightSample sample_position(const Vec3f& position, const Vec3f& point) {
    const Vec3f to_light = position - point;
    const float squared = length_squared(to_light);
    if (!(squared > 0.0f)) return {};
    LightSample sample;
    sample.distance = std::sqrt(squared);
    sample.wi = to_light * (1.0f / sample.distance);
    sample.end = position;
    sample.is_delta = true;
    return sample;
}

}  // namespace

LightSample PointLight::sample(const Vec3f& point, Vec2f) const {
    LightSample sample = sample_position(position, point);
    if (sample.is_delta) sample.radiance = intensity / (sample.distance * sample.distance);
    return sample;
}

float PointLight::power(float) const {
    return 4.0f * kPi * average(intensity);
}

float SpotLight::falloff(float cos_angle) const {
    // Equal cones, also those that only single precision makes equal, are a hard edge; the ramp is never over nothing.
    if (cos_angle >= cos_inner) return 1.0f;
    if (cos_angle <= cos_outer) return 0.0f;
    const float ramp = (cos_angle - cos_outer) / (cos_inner - cos_outer);
    return ramp * ramp;
}

LightSample SpotLight::sample(const Vec3f& point, Vec2f) const {
    LightSample sample = sample_position(position, point);
    if (sample.is_delta)
        sample.radiance = intensity * (falloff(dot(-sample.wi, axis)) / (sample.distance * sample.distance));
    return sample;
}

float SpotLight::power(float) const {
    // The squared ramp integrates to a third of the solid angle between the cones.
    return 2.0f * kPi * average(intensity) * (1.0f - cos_inner + (cos_inner - cos_outer) / 3.0f);
}

LightSample DirectionalLight::sample(const Vec3f&, Vec2f) const {
    LightSample sample;
    sample.wi = -direction;
    sample.radiance = irradiance;
    sample.is_delta = true;
    return sample;
}

float DirectionalLight::power(float scene_radius) const {
    return kPi * scene_radius * scene_radius * average(irradiance);
}

}  // namespace etendue
