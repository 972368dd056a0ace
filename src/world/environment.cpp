#include "world/environment.h"

#include "light/light.h"

namespace etendue {

Rgb Environment::radiance(const Vec3f& direction) const {
    return light() != kNone ? etendue::environment_radiance(data_.lights[data_.environment], direction) : Rgb();
}

void Environment::look(std::span<const Vec3f> directions, std::span<EnvironmentRadiance> seen) const {
    etendue::look_at_environment(data_.lights[data_.environment], directions, seen);
}

void Environment::sample_light(std::span<const Vec2f> u, std::span<LightSample> samples) const {
    sample_environment_compensated(data_.lights[data_.environment], u, samples);
}

float Environment::pdf_solid_angle(const Vec3f& direction) const {
    if (light() == kNone) return 0.0f;
    return compensated_environment_pdf_solid_angle(data_.lights[data_.environment], direction);
}

LightSample Environment::sample_all(const Vec3f& point, Vec2f u) const {
    if (light() == kNone) return {};
    return etendue::sample_light(data_.lights[data_.environment], point, u, u);
}

float Environment::emission_pdf_solid_angle(const Vec3f& direction) const {
    if (light() == kNone) return 0.0f;
    return etendue::environment_pdf_solid_angle(data_.lights[data_.environment], direction);
}

}  // namespace etendue
