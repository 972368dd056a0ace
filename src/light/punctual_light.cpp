#include "light/punctual_light.h"

#include "core/frame.h"
#include "sampling/warp.h"

#include <algorithm>
#include <cmath>
#include <numbers>

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

EmissionSample PointLight::sample_emission(const EmissionNumbers& u, const SceneSphere&) const {
    EmissionSample sample = sample_emission_in_cone(position, {0.0f, 0.0f, 1.0f}, -1.0f, u.direction);
    sample.radiance = intensity;
    return sample;
}

float PointLight::emission_pdf(const Vec3f& direction, float, const SceneSphere&) const {
    return emission_in_cone_pdf_solid_angle(direction, {0.0f, 0.0f, 1.0f}, -1.0f);
}

LightCone<float> PointLight::cone(std::uint32_t) const {
    return {{0.0f, 0.0f, 1.0f}, -1.0f};
}

void PointLight::turn(EmissionSample& sample, const Vec3f& direction) const {
    sample.direction = direction;
    sample.radiance = intensity;
    sample.pdf_direction_solid_angle = emission_pdf(direction, 1.0f, {});
}

float PointLight::power(float) const {
    return 4.0f * kPi * average(intensity);
}

LightBounds PointLight::bounds() const {
    return bounds_of_point(position, {.theta_o = std::numbers::pi}, power(0.0f));
}

LightSample SpotLight::sample(const Vec3f& point, Vec2f) const {
    LightSample sample = sample_position(position, point);
    if (sample.is_delta)
        sample.radiance = intensity * (falloff(dot(-sample.wi, axis)) / (sample.distance * sample.distance));
    return sample;
}

EmissionSample SpotLight::sample_emission(const EmissionNumbers& u, const SceneSphere&) const {
    EmissionSample sample = sample_emission_in_cone(position, axis, cos_outer, u.direction);
    sample.radiance = intensity * falloff(dot(sample.direction, axis));
    return sample;
}

float SpotLight::emission_pdf(const Vec3f& direction, float, const SceneSphere&) const {
    return emission_in_cone_pdf_solid_angle(direction, axis, cos_outer);
}

LightCone<float> SpotLight::cone(std::uint32_t) const {
    return {axis, cos_outer};
}

void SpotLight::turn(EmissionSample& sample, const Vec3f& direction) const {
    sample.direction = direction;
    sample.radiance = intensity * falloff(dot(direction, axis));
    sample.pdf_direction_solid_angle = emission_pdf(direction, 1.0f, {});
}

float SpotLight::power(float) const {
    return average(intensity) * spot_solid_angle(cos_inner, cos_outer);
}

LightBounds SpotLight::bounds() const {
    const double inner = std::acos(static_cast<double>(std::clamp(cos_inner, -1.0f, 1.0f)));
    const double outer = std::acos(static_cast<double>(std::clamp(cos_outer, -1.0f, 1.0f)));
    // The angle of emission ends at a right one.
    const double theta_e = std::clamp(outer - inner, 0.0, 0.5 * std::numbers::pi);
    return bounds_of_point(position, {.axis = axis, .theta_o = std::max(inner, outer - theta_e), .theta_e = theta_e},
                           power(0.0f));
}

LightSample DirectionalLight::sample(const Vec3f&, Vec2f) const {
    LightSample sample;
    sample.wi = -direction;
    sample.radiance = irradiance;
    sample.is_delta = true;
    return sample;
}

EmissionSample DirectionalLight::sample_emission(const EmissionNumbers& u, const SceneSphere& scene) const {
    EmissionSample sample = sample_emission_from_afar(direction, scene, u.position);
    sample.radiance = irradiance;
    return sample;
}

float DirectionalLight::emission_pdf(const Vec3f&, float, const SceneSphere& scene) const {
    return emission_from_afar_pdf_area(scene);
}

float DirectionalLight::power(float scene_radius) const {
    return kPi * scene_radius * scene_radius * average(irradiance);
}

LightBounds bounds_of_point(const Vec3f& position, const EmissionCone& cone, float power) {
    LightBounds bounds;
    bounds.box.extend(position);
    bounds.cone = cone;
    bounds.power = static_cast<double>(power);
    return bounds;
}

namespace {

/// A cone that single precision closes still has a density.
float opened(float cos_max) {
    return std::min(cos_max, kOneMinusEpsilon);
}

float cone_density(float cos_max) {
    return kInvPi * 0.5f / (1.0f - opened(cos_max));
}

}  // namespace

EmissionSample sample_emission_in_cone(const Vec3f& position, const Vec3f& axis, float cos_max, Vec2f u) {
    const Vec3f local = square_to_cone(u, opened(cos_max));
    EmissionSample sample;
    sample.position = position;
    sample.direction = normalize(Frame::from_normal(axis).to_world(local));
    sample.pdf_direction_solid_angle = cone_density(cos_max);
    return sample;
}

float emission_in_cone_pdf_solid_angle(const Vec3f& direction, const Vec3f& axis, float cos_max) {
    return dot(direction, axis) >= opened(cos_max) ? cone_density(cos_max) : 0.0f;
}

EmissionSample sample_emission_from_afar(const Vec3f& direction, const SceneSphere& scene, Vec2f u) {
    // The disk touches the sphere from outside; a little further, lest it cuts what touches the sphere from inside.
    constexpr float kBefore = 1.001f;
    const Vec2f d = square_to_disk(u);
    const Frame frame = Frame::from_normal(direction);
    EmissionSample sample;
    sample.position = scene.center + (frame.tangent * d.x + frame.bitangent * d.y - direction * kBefore) * scene.radius;
    sample.direction = direction;
    sample.pdf_position_area = emission_from_afar_pdf_area(scene);
    return sample;
}

float emission_from_afar_pdf_area(const SceneSphere& scene) {
    return kInvPi / (scene.radius * scene.radius);
}

}  // namespace etendue
