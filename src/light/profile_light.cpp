#include "light/profile_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace etendue {

LightSample ProfileLight::sample(const Vec3f& point, Vec2f u) const {
    LightSample sample = std::visit([&](const auto& l) { return l.sample(point, u); }, lamp);
    if (is_black(sample.radiance)) return sample;
    sample.radiance *= profile->candela(frame.to_local(-sample.wi));
    return sample;
}

float ProfileLight::cos_emission() const {
    const float cos_last = std::cos(profile->last_vertical());
    const SpotLight* spot = std::get_if<SpotLight>(&lamp);
    return spot != nullptr ? std::max(cos_last, spot->cos_outer) : cos_last;
}

float ProfileLight::emission_pdf(const Vec3f& direction, float, const SceneSphere&) const {
    return emission_in_cone_pdf_solid_angle(direction, -frame.normal, cos_emission());
}

EmissionSample ProfileLight::sample_emission(const EmissionNumbers& u, const SceneSphere&) const {
    EmissionSample sample = sample_emission_in_cone(position(), -frame.normal, cos_emission(), u.direction);
    sample.radiance = intensity(sample.direction);
    return sample;
}

LightCone<float> ProfileLight::cone(std::uint32_t) const {
    return {-frame.normal, cos_emission()};
}

void ProfileLight::turn(EmissionSample& sample, const Vec3f& direction) const {
    sample.direction = direction;
    sample.radiance = intensity(direction);
    sample.pdf_direction_solid_angle = emission_pdf(direction, 1.0f, {});
}

Rgb ProfileLight::intensity(const Vec3f& direction) const {
    const SpotLight* spot = std::get_if<SpotLight>(&lamp);
    const Rgb even = spot != nullptr ? spot->intensity * spot->falloff(dot(direction, spot->axis))
                                     : std::get<PointLight>(lamp).intensity;
    return even * profile->candela(frame.to_local(direction));
}

LightBounds ProfileLight::bounds() const {
    return bounds_of_point(
        position(), {.axis = -frame.normal, .theta_o = std::acos(static_cast<double>(cos_emission()))}, power(0.0f));
}

float ProfileLight::power(float) const {
    constexpr int kSteps = 1024;
    const SpotLight* spot = std::get_if<SpotLight>(&lamp);
    const Rgb intensity = spot != nullptr ? spot->intensity : std::get<PointLight>(lamp).intensity;
    auto end = static_cast<double>(profile->last_vertical());
    if (spot != nullptr) end = std::min(end, std::acos(static_cast<double>(spot->cos_outer)));
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) {
        const double theta = (i + 0.5) / kSteps * end;
        const float falloff = spot != nullptr ? spot->falloff(static_cast<float>(std::cos(theta))) : 1.0f;
        sum += profile->mean_candela(theta) * static_cast<double>(falloff) * std::sin(theta);
    }
    return static_cast<float>(sum * end / kSteps * 2.0 * std::numbers::pi) * average(intensity);
}

}  // namespace etendue
