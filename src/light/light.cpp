#include "light/light.h"

namespace etendue {

LightSample sample_light(const Light& light, const Vec3f& point, Vec2f u) {
    return std::visit([&](const auto& l) { return l.sample(point, u); }, light);
}

float light_power(const Light& light, float scene_radius) {
    return std::visit([&](const auto& l) { return l.power(scene_radius); }, light);
}

Rgb environment_radiance(const Light& light, const Vec3f& direction) {
    if (const auto* constant = std::get_if<ConstantEnvironment>(&light)) return constant->radiance(direction);
    if (const auto* image = std::get_if<ImageEnvironment>(&light)) return image->radiance(direction);
    return {};
}

float environment_pdf_solid_angle(const Light& light, const Vec3f& direction) {
    if (const auto* constant = std::get_if<ConstantEnvironment>(&light)) return constant->pdf_solid_angle(direction);
    if (const auto* image = std::get_if<ImageEnvironment>(&light)) return image->pdf_solid_angle(direction);
    return 0.0f;
}

LightSelector::LightSelector(std::span<const Light> lights, float scene_radius) {
    std::vector<double> powers;
    powers.reserve(lights.size());
    for (const Light& light : lights) powers.push_back(static_cast<double>(light_power(light, scene_radius)));
    by_power_ = AliasTable(powers);
}

}  // namespace etendue
