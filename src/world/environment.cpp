#include "world/environment.h"

#include "light/light.h"

namespace etendue {

std::span<const std::uint32_t> Environment::met(bool by_camera) const {
    const std::span<const std::uint32_t> all = data_.lights_met_afar;
    return by_camera ? all.first(light() != kNone && data_.environment_visible ? 1 : 0) : all;
}

Rgb Environment::radiance(std::uint32_t light, const Vec3f& direction) const {
    return light != kNone ? radiance_from_afar(data_.lights[light], direction) : Rgb();
}

void Environment::look(std::span<const Vec3f> directions, std::span<EnvironmentRadiance> seen) const {
    etendue::look_at_environment(data_.lights[data_.environment], directions, seen);
}

void Environment::sample_light(std::span<const Vec2f> u, std::span<LightSample> samples) const {
    sample_environment_compensated(data_.lights[data_.environment], u, samples);
}

float Environment::pdf_solid_angle(std::uint32_t light, const Vec3f& direction) const {
    return light != kNone ? compensated_pdf_solid_angle_from_afar(data_.lights[light], direction) : 0.0f;
}

LightSample Environment::sample_all(const Vec3f& point, Vec2f u) const {
    if (light() == kNone) return {};
    return etendue::sample_light(data_.lights[data_.environment], point, u, u);
}

float Environment::emission_pdf_solid_angle(std::uint32_t light, const Vec3f& direction) const {
    return light != kNone ? pdf_solid_angle_from_afar(data_.lights[light], direction) : 0.0f;
}

}  // namespace etendue
