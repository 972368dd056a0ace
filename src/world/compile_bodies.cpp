#include "world/compile_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace etendue {

namespace {

float extinction_of(float color, float distance) {
    // Black would be an infinite coefficient; after the distance a millionth is left.
    constexpr float kLeast = 1e-6f;
    return std::isinf(distance) ? 0.0f : -std::log(std::clamp(color, kLeast, 1.0f)) / distance;
}

Filling compile_volume(const VolumeDesc& desc, float ior, const ColorMatrix& from_rec709) {
    const Rgb color = from_rec709(desc.attenuation_color);
    Filling filling{.ior = ior, .dispersion = desc.dispersion, .priority = desc.priority};
    filling.medium.extinction = {extinction_of(color.r, desc.attenuation_distance),
                                 extinction_of(color.g, desc.attenuation_distance),
                                 extinction_of(color.b, desc.attenuation_distance)};
    filling.medium.phase.g = desc.scatter_anisotropy;
    if (!is_black(desc.multiscatter_color))
        filling.medium.single_scatter_albedo = HomogeneousMedium::albedo_from_multiscatter(
            clamp_negative(from_rec709(desc.multiscatter_color)), desc.scatter_anisotropy);
    return filling;
}

/// Through a diffuse boundary light does not refract, so nothing tells what index lies behind it.
Filling compile_subsurface(const SubsurfaceDesc& desc, const ColorMatrix& from_rec709) {
    Filling filling{.priority = desc.priority};
    filling.medium.extinction = {1.0f / desc.radius.r, 1.0f / desc.radius.g, 1.0f / desc.radius.b};
    filling.medium.phase.g = desc.anisotropy;
    filling.medium.single_scatter_albedo =
        HomogeneousMedium::albedo_from_multiscatter(clamp_negative(from_rec709(desc.albedo)), desc.anisotropy);
    return filling;
}

/// Diagonal of the bounds of a mesh where it is placed, metres.
float size_of(const Geometry& geometry, const Instance& instance) {
    Bounds bounds;
    for (const Vec3f& p : geometry.positions) bounds.extend(instance.baked ? p : transform_point(instance.to_world, p));
    return bounds.empty() ? 0.0f : length(bounds.size());
}

/// A boundary as it is placed, before it has its number.
struct Candidate {
    int priority;
    float size;
    std::uint32_t slot;
    std::uint32_t filling;
};

}  // namespace

std::optional<Filling> compile_filling(const MaterialDesc& desc, const ColorMatrix& from_rec709) {
    if (const auto* dielectric = std::get_if<DielectricDesc>(&desc.override_model))
        return compile_volume(dielectric->volume, dielectric->ior, from_rec709);
    if (const auto* subsurface = std::get_if<SubsurfaceDesc>(&desc.override_model))
        return compile_subsurface(*subsurface, from_rec709);
    const bool transmits = desc.transmission > 0.0f || desc.diffuse_transmission.factor > 0.0f;
    const bool is_gltf = std::holds_alternative<std::monostate>(desc.override_model);
    if (!is_gltf || !desc.volume.closed || !transmits || desc.ior == 0.0f) return std::nullopt;
    return compile_volume(desc.volume, desc.ior, from_rec709);
}

void compile_bodies(WorldData& data) {
    std::vector<Candidate> candidates;
    for (const Instance& instance : data.instances) {
        for (std::uint32_t g = 0; g < instance.geometry_count; ++g) {
            const Geometry& geometry = data.geometries[instance.first_geometry + g];
            const std::uint32_t filling = data.materials[geometry.material].filling;
            if (filling == kNone || geometry.triangles.empty()) continue;
            candidates.push_back(
                {data.fillings[filling].priority, size_of(geometry, instance), instance.first_light_slot + g, filling});
        }
    }
    if (candidates.empty()) return;
    // What is wholly inside another is smaller than it, and is what one means to see there.
    std::ranges::sort(candidates, [](const Candidate& a, const Candidate& b) {
        return std::tuple(-a.priority, a.size, a.slot) < std::tuple(-b.priority, b.size, b.slot);
    });
    data.body_of_slot.assign(data.light_of_slot.size(), kNone);
    for (const Candidate& candidate : candidates) {
        data.body_of_slot[candidate.slot] = static_cast<std::uint32_t>(data.filling_of_body.size());
        data.filling_of_body.push_back(candidate.filling);
    }
}

}  // namespace etendue
