#include "light/light.h"

#include <algorithm>

namespace etendue {

LightSample sample_light(const Light& light, const Vec3f& point, Vec2f u_triangle, Vec2f u) {
    if (const MeshLight* mesh = std::get_if<MeshLight>(&light)) return mesh->sample(point, u_triangle, u);
    if (const ShapeLight* shape = std::get_if<ShapeLight>(&light)) return shape->sample(point, u_triangle, u);
    return std::visit(
        [&](const auto& l) {
            if constexpr (requires { l.sample(point, u); })
                return l.sample(point, u);
            else
                return LightSample{};
        },
        light);
}

LightSample sample_light_compensated(const Light& light, const Vec3f& point, Vec2f u_triangle, Vec2f u) {
    if (const auto* image = std::get_if<ImageEnvironment>(&light)) return image->sample_compensated(point, u);
    if (const auto* constant = std::get_if<ConstantEnvironment>(&light)) return constant->sample_compensated(point, u);
    return sample_light(light, point, u_triangle, u);
}

void sample_environment_compensated(const Light& light, std::span<const Vec2f> u, std::span<LightSample> samples) {
    if (const auto* image = std::get_if<ImageEnvironment>(&light)) return image->sample_compensated(u, samples);
    // A constant one has nothing that is brighter than its mean.
    std::ranges::fill(samples, LightSample());
}

EmissionSample sample_emission(const Light& light, const EmissionNumbers& u, const SceneSphere& scene) {
    return std::visit([&](const auto& l) { return l.sample_emission(u, scene); }, light);
}

float emission_pdf(const Light& light, const Vec3f& direction, float cos_light, const SceneSphere& scene) {
    return std::visit([&](const auto& l) { return l.emission_pdf(direction, cos_light, scene); }, light);
}

std::optional<LightCone<float>> light_cone(const Light& light, std::uint32_t triangle) {
    return std::visit(
        [&]<typename Kind>(const Kind& l) -> std::optional<LightCone<float>> {
            if constexpr (Kind::is_at_infinity())
                return std::nullopt;
            else
                return l.cone(triangle);
        },
        light);
}

void turn_emission(const Light& light, EmissionSample& sample, const Vec3f& direction) {
    std::visit(
        [&]<typename Kind>(const Kind& l) {
            if constexpr (!Kind::is_at_infinity()) l.turn(sample, direction);
        },
        light);
}

bool is_delta_light(const Light& light) {
    return std::visit([](const auto& l) { return l.is_delta(); }, light);
}

std::size_t light_bytes(const Light& light) {
    return std::visit([](const auto& l) { return l.bytes(); }, light);
}

bool is_at_infinity(const Light& light) {
    return std::visit([](const auto& l) { return l.is_at_infinity(); }, light);
}

float light_power(const Light& light, float scene_radius) {
    return std::visit([&](const auto& l) { return l.power(scene_radius); }, light);
}

float compensated_power(const Light& light, float scene_radius) {
    return std::visit(
        [&]<typename Kind>(const Kind& l) {
            if constexpr (Kind::is_environment())
                return l.compensated_power(scene_radius);
            else
                return l.power(scene_radius);
        },
        light);
}

std::optional<LightBounds> light_bounds(const Light& light) {
    return std::visit(
        []<typename Kind>(const Kind& l) -> std::optional<LightBounds> {
            if constexpr (Kind::is_at_infinity())
                return std::nullopt;
            else
                return l.bounds();
        },
        light);
}

std::optional<Vec3f> light_point(const Light& light) {
    return std::visit([](const auto& l) { return l.point(); }, light);
}

Rgb radiance_from_afar(const Light& light, const Vec3f& direction) {
    return std::visit(
        [&](const auto& l) {
            if constexpr (requires { l.radiance(direction); })
                return l.radiance(direction);
            else
                return Rgb();
        },
        light);
}

float pdf_solid_angle_from_afar(const Light& light, const Vec3f& direction) {
    return std::visit(
        [&](const auto& l) {
            if constexpr (requires { l.pdf_solid_angle(direction); })
                return l.pdf_solid_angle(direction);
            else
                return 0.0f;
        },
        light);
}

float compensated_pdf_solid_angle_from_afar(const Light& light, const Vec3f& direction) {
    if (std::holds_alternative<ConstantEnvironment>(light)) return 0.0f;
    if (const auto* image = std::get_if<ImageEnvironment>(&light)) return image->compensated_pdf_solid_angle(direction);
    return pdf_solid_angle_from_afar(light, direction);
}

void look_at_environment(const Light& light, std::span<const Vec3f> directions, std::span<EnvironmentRadiance> seen) {
    if (const auto* image = std::get_if<ImageEnvironment>(&light)) return image->look(directions, seen);
    const auto* constant = std::get_if<ConstantEnvironment>(&light);
    std::ranges::fill(seen, EnvironmentRadiance{constant != nullptr ? constant->value : Rgb()});
}

LightSelector::LightSelector(std::span<const Light> lights, float scene_radius) {
    constexpr double kAny = 0.1;
    std::vector<double> weights;
    weights.reserve(lights.size());
    double total = 0.0;
    double shining = 0.0;
    for (const Light& light : lights) {
        weights.push_back(static_cast<double>(light_power(light, scene_radius)));
        total += weights.back();
        if (weights.back() > 0.0) shining += 1.0;
    }
    for (double& weight : weights)
        if (weight > 0.0) weight += kAny / (1.0 - kAny) * total / shining;
    table_ = AliasTable(weights);
}

}  // namespace etendue
