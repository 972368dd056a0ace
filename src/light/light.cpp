#include "light/light.h"

#include <algorithm>

namespace etendue {

namespace {

/// True of the kinds of light that rays meet infinitely far away.
template <typename Kind>
constexpr bool kIsMetAfar = Kind::is_at_infinity() && !Kind::is_delta();

}  // namespace

LightSample sample_light(const Light& light, const Vec3f& point, Vec2f u_triangle, Vec2f u) {
    return std::visit(
        [&]<typename Kind>(const Kind& l) {
            if constexpr (kIsSurfaceLight<Kind>)
                return l.sample(point, u_triangle, u);
            else
                return l.sample(point, u);
        },
        light);
}

LightSample sample_light_compensated(const Light& light, const Vec3f& point, Vec2f u_triangle, Vec2f u) {
    return std::visit(
        [&]<typename Kind>(const Kind& l) {
            if constexpr (Kind::is_environment())
                return l.sample_compensated(point, u);
            else
                return sample_light(light, point, u_triangle, u);
        },
        light);
}

void sample_environment_compensated(const Light& light, std::span<const Vec2f> u, std::span<LightSample> samples) {
    std::visit(
        [&]<typename Kind>(const Kind& l) {
            if constexpr (Kind::is_environment())
                l.sample_compensated(u, samples);
            else
                std::ranges::fill(samples, LightSample());
        },
        light);
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
        [&]<typename Kind>(const Kind& l) {
            if constexpr (kIsMetAfar<Kind>)
                return l.radiance(direction);
            else
                return Rgb();
        },
        light);
}

float pdf_solid_angle_from_afar(const Light& light, const Vec3f& direction) {
    return std::visit(
        [&]<typename Kind>(const Kind& l) {
            if constexpr (kIsMetAfar<Kind>)
                return l.pdf_solid_angle(direction);
            else
                return 0.0f;
        },
        light);
}

float compensated_pdf_solid_angle_from_afar(const Light& light, const Vec3f& direction) {
    return std::visit(
        [&]<typename Kind>(const Kind& l) {
            if constexpr (Kind::is_environment())
                return l.compensated_pdf_solid_angle(direction);
            else if constexpr (kIsMetAfar<Kind>)
                return l.pdf_solid_angle(direction);
            else
                return 0.0f;
        },
        light);
}

void look_at_environment(const Light& light, std::span<const Vec3f> directions, std::span<EnvironmentRadiance> seen) {
    std::visit(
        [&]<typename Kind>(const Kind& l) {
            if constexpr (Kind::is_environment())
                l.look(directions, seen);
            else
                std::ranges::fill(seen, EnvironmentRadiance{Rgb()});
        },
        light);
}

AliasTable choice_by_power(std::span<const Light> lights, float scene_radius) {
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
    return AliasTable(weights);
}

}  // namespace etendue
