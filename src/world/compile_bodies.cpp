#include "world/compile_parts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
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

/// Bounds where an instance places a geometry whose own bounds are `local`.
Bounds placed(const Bounds& local, const Instance& instance) {
    if (instance.baked || local.empty()) return local;
    Bounds world;
    for (int corner = 0; corner < 8; ++corner)
        world.extend(transform_point(instance.to_world, {(corner & 1) != 0 ? local.max.x : local.min.x,
                                                         (corner & 2) != 0 ? local.max.y : local.min.y,
                                                         (corner & 4) != 0 ? local.max.z : local.min.z}));
    return world;
}

/// The boundary of a filling in one instance, which may be of several geometries, before it has its number.
struct Candidate {
    int priority;
    Bounds bounds;
    std::uint32_t filling;

    [[nodiscard]] float size() const { return bounds.empty() ? 0.0f : length(bounds.size()); }
};

}  // namespace

std::optional<Filling> compile_filling(const MaterialDesc& desc, const ColorMatrix& from_rec709) {
    if (const auto* dielectric = std::get_if<DielectricDesc>(&desc.override_model))
        return compile_volume(dielectric->volume, dielectric->ior, from_rec709);
    if (const auto* subsurface = std::get_if<SubsurfaceDesc>(&desc.override_model))
        return compile_subsurface(*subsurface, from_rec709);
    // A surface with holes encloses nothing.
    if (desc.alpha_mode == AlphaMode::Mask) return std::nullopt;
    const bool transmits = desc.transmission > 0.0f || desc.diffuse_transmission.factor > 0.0f;
    const bool is_gltf = std::holds_alternative<std::monostate>(desc.override_model);
    if (!is_gltf || !desc.volume.closed || !transmits || desc.ior == 0.0f) return std::nullopt;
    return compile_volume(desc.volume, desc.ior, from_rec709);
}

void compile_bodies(WorldData& data) {
    const auto filling_of = [&](std::size_t geometry) {
        return data.materials[data.geometries[geometry].material].filling;
    };
    std::vector<Bounds> local_bounds(data.geometries.size());
    for (std::size_t g = 0; g < data.geometries.size(); ++g)
        if (filling_of(g) != kNone)
            for (const Vec3f& p : data.geometries[g].positions) local_bounds[g].extend(p);

    // Exporters cut meshes into parts; those of one instance with one filling are one boundary.
    std::vector<Candidate> candidates;
    std::vector<std::uint32_t> candidate_of_slot(data.light_of_slot.size(), kNone);
    std::map<std::uint32_t, std::uint32_t> of_instance;  // candidate by filling
    for (const Instance& instance : data.instances) {
        of_instance.clear();
        for (std::uint32_t g = 0; g < instance.geometry_count; ++g) {
            const std::uint32_t geometry = instance.first_geometry + g;
            const std::uint32_t filling = filling_of(geometry);
            if (filling == kNone || data.geometries[geometry].triangles.empty()) continue;
            const auto [entry, is_new] =
                of_instance.try_emplace(filling, static_cast<std::uint32_t>(candidates.size()));
            if (is_new) candidates.push_back({data.fillings[filling].priority, {}, filling});
            candidates[entry->second].bounds.extend(placed(local_bounds[geometry], instance));
            candidate_of_slot[instance.first_light_slot + g] = entry->second;
        }
    }
    if (candidates.empty()) return;
    // What is wholly inside another is smaller than it, and is what one means to see there.
    std::vector<std::uint32_t> order(candidates.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
        return std::tuple(-candidates[a].priority, candidates[a].size(), a) <
               std::tuple(-candidates[b].priority, candidates[b].size(), b);
    });
    std::vector<std::uint32_t> body_of_candidate(candidates.size());
    for (const std::uint32_t candidate : order) {
        body_of_candidate[candidate] = static_cast<std::uint32_t>(data.filling_of_body.size());
        data.filling_of_body.push_back(candidates[candidate].filling);
    }
    data.body_of_slot.assign(candidate_of_slot.size(), kNone);
    for (std::size_t slot = 0; slot < candidate_of_slot.size(); ++slot)
        if (candidate_of_slot[slot] != kNone) data.body_of_slot[slot] = body_of_candidate[candidate_of_slot[slot]];
}

}  // namespace etendue
