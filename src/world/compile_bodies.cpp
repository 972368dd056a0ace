#include "core/shown_text.h"
#include "world/compile_parts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

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

/// Returns whether light scatters so often on its way through a body of `size` metres that connecting each vertex there
/// with each takes more time than it saves.
bool is_dense(const HomogeneousMedium& medium, float size) {
    constexpr float kDense = 30.0f;  // free paths across the body; measured with white and grey spheres under a lamp
    return medium.scatters() && min_component(medium.extinction) * size >= kDense;
}

/// Bounds where an instance places a geometry whose own bounds are `local`.
Bounds placed(const Bounds& local, const Instance& instance) {
    return instance.baked ? local : placed(local, instance.to_world);
}

/// The boundary of a filling in one instance, which may be of several geometries, before it has its number.
struct Candidate {
    int priority;
    Bounds bounds;
    std::uint32_t filling;

    [[nodiscard]] float size() const { return bounds.empty() ? 0.0f : length(bounds.size()); }
};

/// Sums over triangles that tell a closed surface from one with holes, and its inside from its outside.
class SurfaceSums {
  public:
    /// `bounds` of the mesh, not empty: what is less than a ten thousandth of its size apart counts as one vertex, as
    /// the two ends of a seam do that an exporter has rounded differently.
    explicit SurfaceSums(const Bounds& bounds)
        : origin_(in_double(bounds.min)), cell_(1e-4 * static_cast<double>(length(bounds.size()))) {}

    void add(const Geometry& geometry) { parts_.push_back(&geometry); }
    /// Returns whether a flat shape is among the parts, which encloses nothing.
    [[nodiscard]] bool has_flat_shape() const {
        return std::ranges::any_of(parts_,
                                   [](const Geometry* part) { return part->shape && is_flat(part->shape->kind()); });
    }
    /// True if every edge is passed as often in one direction as in the other, but for a chance of 2⁻⁶⁴.
    [[nodiscard]] bool is_closed() const {
        if (has_flat_shape()) return false;
        for (std::size_t grid = 0; grid < kGrids; ++grid)
            if (edge_sum(grid) == 0) return true;
        return false;
    }
    /// Volume of a closed surface in its own space; it is negative if the fronts are inside.
    [[nodiscard]] double volume() const {
        double volume = 0.0;
        for (const Geometry* part : parts_) {
            if (part->shape) volume += part->shape->volume();
            for (const auto& [a, b, c] : part->triangles)
                volume += corner(*part, a).dot(corner(*part, b).cross(corner(*part, c))) / 6.0;
        }
        return volume;
    }

  private:
    /// Two ends of a seam that lie in different cells of one do not in another.
    static constexpr std::size_t kGrids = 4;

    static Vec3d in_double(const Vec3f& v) {
        return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
    }
    [[nodiscard]] Vec3d corner(const Geometry& geometry, std::uint32_t vertex) const {
        return in_double(geometry.positions[vertex]) - origin_;
    }
    [[nodiscard]] std::uint64_t key(const Vec3d& p, std::size_t grid) const {
        const double shift = (static_cast<double>(grid) + 0.37) / static_cast<double>(kGrids);
        std::uint64_t bits = 0;
        for (int i = 0; i < 3; ++i)
            bits =
                mixed(bits ^ static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(p[i] / cell_ + shift))));
        return bits;
    }
    /// The finalizer of SplitMix64 (Steele, Lea and Flood 2014).
    static std::uint64_t mixed(std::uint64_t x) {
        x += 0x9e3779b97f4a7c15u;
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
        x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
        return x ^ (x >> 31);
    }
    [[nodiscard]] std::uint64_t edge_sum(std::size_t grid) const {
        std::uint64_t sum = 0;
        std::vector<std::uint64_t> keys;
        for (const Geometry* part : parts_) {
            keys.clear();
            for (std::uint32_t v = 0; v < part->positions.size(); ++v) keys.push_back(key(corner(*part, v), grid));
            for (const auto& triangle : part->triangles)
                for (std::size_t i = 0; i < 3; ++i) add_edge(keys[triangle[i]], keys[triangle[(i + 1) % 3]], sum);
        }
        return sum;
    }
    static void add_edge(std::uint64_t from, std::uint64_t to, std::uint64_t& sum) {
        if (from < to)
            sum += mixed(mixed(from) ^ to);
        else if (to < from)
            sum -= mixed(mixed(to) ^ from);
    }

    Vec3d origin_;
    double cell_;
    std::vector<const Geometry*> parts_;
};

/// Warns of bodies whose inside is not known, once for each mesh.
void check_surfaces(const SceneDesc& scene, const WorldData& data, std::span<const Bounds> local_bounds,
                    ProblemList& problems) {
    std::set<std::pair<std::int32_t, std::uint32_t>> checked;  // mesh of the scene, and filling
    for (std::size_t i = 0; i < data.instances.size(); ++i) {
        const Instance& instance = data.instances[i];
        Bounds bounds;
        for (std::uint32_t g = 0; g < instance.geometry_count; ++g)
            bounds.extend(local_bounds[instance.first_geometry + g]);
        if (bounds.empty() || !(length(bounds.size()) > 0.0f)) continue;
        std::map<std::uint32_t, SurfaceSums> sums;  // by filling
        for (std::uint32_t g = 0; g < instance.geometry_count; ++g) {
            const Geometry& geometry = data.geometries[instance.first_geometry + g];
            const std::uint32_t filling = data.materials[geometry.material].filling;
            if (filling != kNone && !geometry.is_empty()) sums.try_emplace(filling, bounds).first->second.add(geometry);
        }
        const InstanceDesc& desc = scene.instances[i];
        for (const auto& [filling, surface] : sums) {
            if (!checked.insert({desc.mesh.index, filling}).second) continue;
            const std::string what = desc.name.empty() ? std::string("a body") : "the body '" + desc.name + "'";
            if (surface.has_flat_shape())
                problems.warning(desc.location, what +
                                                    " is flat: disks and rectangles enclose nothing. Take a cylinder, "
                                                    "or leave its material's thickness out to make it a thin sheet");
            else if (!surface.is_closed())
                problems.warning(desc.location,
                                 what +
                                     " is not closed: its mesh has edges of one triangle only, or triangles whose "
                                     "fronts face each other, so that what is inside is not known. Close it, or "
                                     "leave its material's thickness out to make it a thin sheet");
            else if (surface.volume() < 0.0)
                problems.warning(desc.location, what +
                                                    " is inside out: the fronts of its triangles, counter-clockwise, "
                                                    "are inside. Turn them around");
        }
    }
}

/// Notes closed meshes whose materials transmit as thin sheets do: the thickness may have got lost, as it does where
/// Blender's exporter writes no KHR_materials_volume.
void note_closed_sheets(const SceneDesc& scene, const WorldData& data, ProblemList& problems) {
    const auto is_sheet = [&](const Geometry& geometry) {
        const MaterialDesc& desc = scene.materials[geometry.material];
        // Filled, what neither bends nor absorbs light is what it was, such as the surface of a soft lamp.
        const bool would_change = desc.ior != 1.0f || !std::isinf(desc.volume.attenuation_distance);
        return would_change && desc.transmission > 0.0f && !desc.volume.closed && !desc.unlit &&
               desc.alpha_mode != AlphaMode::Mask && std::holds_alternative<std::monostate>(desc.override_model);
    };
    // What encloses less than this part of the cube of its size is flat.
    constexpr double kLeastVolume = 1e-6;
    std::set<std::int32_t> seen;
    for (std::size_t i = 0; i < data.instances.size(); ++i) {
        const Instance& instance = data.instances[i];
        const InstanceDesc& desc = scene.instances[i];
        const std::span geometries(data.geometries.data() + instance.first_geometry, instance.geometry_count);
        if (!std::ranges::any_of(geometries, is_sheet) || !seen.insert(desc.mesh.index).second) continue;
        Bounds bounds;
        for (const Geometry& geometry : geometries)
            if (is_sheet(geometry))
                for (const Vec3f& p : geometry.positions) bounds.extend(p);
        const double size = bounds.empty() ? 0.0 : static_cast<double>(length(bounds.size()));
        if (!(size > 0.0)) continue;
        SurfaceSums surface(bounds);
        std::string material;
        for (const Geometry& geometry : geometries) {
            if (!is_sheet(geometry)) continue;
            surface.add(geometry);
            material = scene.materials[geometry.material].name;
        }
        if (!surface.is_closed() || std::abs(surface.volume()) < kLeastVolume * size * size * size) continue;
        problems.note(desc.location,
                      fmt::format("'{0}' is closed, but its material '{1}' transmits without a thickness, so that it "
                                  "is a thin shell: \"materials\": {{\"{1}\": {{\"solid\": true}}}} in render.json "
                                  "fills it",
                                  shown(desc.name), shown(material)));
    }
}

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

void compile_bodies(const SceneDesc& scene, WorldData& data, ProblemList& problems) {
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
            if (filling == kNone || data.geometries[geometry].is_empty()) continue;
            const auto [entry, is_new] =
                of_instance.try_emplace(filling, static_cast<std::uint32_t>(candidates.size()));
            if (is_new) candidates.push_back({data.fillings[filling].priority, {}, filling});
            candidates[entry->second].bounds.extend(placed(local_bounds[geometry], instance));
            candidate_of_slot[instance.first_light_slot + g] = entry->second;
        }
    }
    for (const Candidate& candidate : candidates) {
        HomogeneousMedium& medium = data.fillings[candidate.filling].medium;
        medium.is_dense = medium.is_dense || is_dense(medium, candidate.size());
    }
    note_closed_sheets(scene, data, problems);
    if (candidates.empty()) return;
    check_surfaces(scene, data, local_bounds, problems);
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
