#include "profile/scene_hits.h"

#include "picture/matte_names.h"
#include "scene/material_textures.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Hits by name, the most first.
std::vector<NamedValue> sorted_by_count(const std::map<std::string, double>& counts) {
    std::vector<NamedValue> values;
    values.reserve(counts.size());
    for (const auto& [name, count] : counts) values.push_back({name, count});
    std::ranges::stable_sort(values, std::ranges::greater{}, &NamedValue::value);
    return values;
}

/// Looks on from just before the end of a shadow ray for the lamp that it went to; without length, and so without a
/// hit, where it goes on for ever.
Ray beyond_end(const Ray& ray) {
    constexpr float kBefore = 1e-3f;  // of the ray's length
    Ray end = ray;
    if (!std::isfinite(ray.t_max)) {
        end.t_max = std::numeric_limits<float>::min();
        return end;
    }
    end.origin = ray.origin + ray.direction * (ray.t_max * (1.0f - kBefore));
    end.t_max = 3.0f * kBefore * ray.t_max;
    return end;
}

class HitCounter {
  public:
    HitCounter(const World& world, const SceneHitNames& names) : world_(world), names_(names) {
        for (std::uint32_t light = 0; light < world.lights().count(); ++light)
            if (const std::uint32_t instance = world.lights().emitter(light).instance; instance != kNone)
                lit_instances_.insert(instance);
            else if (!world.lights().is_at_infinity(light))
                has_points_ = true;
    }

    void add_nearest(const std::vector<Ray>& rays, double weight) {
        hits_.resize(rays.size());
        world_.geometry().intersect(rays, hits_, Coherence::Incoherent);
        for (const Hit& hit : hits_) {
            if (!hit.valid()) continue;
            objects_[names_.objects[hit.instance]] += weight;
            const std::uint32_t material = world_.materials().index(hit);
            materials_[names_.materials[material]] += weight;
            for (const std::string& texture : names_.textures[material]) textures_[texture] += weight;
        }
    }

    void add_shadow(const std::vector<Ray>& rays, double weight) {
        ends_.clear();
        ends_.reserve(rays.size());
        for (const Ray& ray : rays) ends_.push_back(beyond_end(ray));
        hits_.resize(rays.size());
        blocked_.resize(rays.size());
        world_.geometry().intersect(ends_, hits_, Coherence::Incoherent);
        world_.geometry().occluded(rays, blocked_);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const std::string* const name = lamp_of(rays[i], hits_[i]);
            if (name == nullptr) continue;
            LampReport& lamp = lamps_[*name];
            lamp.shadow_rays += weight;
            if (blocked_[i] == kOccluded) lamp.blocked += weight;
        }
    }

    [[nodiscard]] SceneHitsReport report() const {
        SceneHitsReport report{.materials = sorted_by_count(materials_),
                               .objects = sorted_by_count(objects_),
                               .textures = sorted_by_count(textures_)};
        report.lamps.reserve(lamps_.size());
        for (const auto& [name, lamp] : lamps_) report.lamps.push_back({name, lamp.shadow_rays, lamp.blocked});
        std::ranges::stable_sort(report.lamps, std::ranges::greater{}, &LampReport::shadow_rays);
        return report;
    }

  private:
    /// Returns the name of the lamp that `ray` leads to; `end` is the hit there. Returns null if the lamp is not
    /// known, for example because `ray` grazes the lamp and meets the wall behind it.
    [[nodiscard]] const std::string* lamp_of(const Ray& ray, const Hit& end) const {
        static const std::string kNoSurface = "lights without a surface";
        if (end.valid() && lit_instances_.contains(end.instance)) return &names_.objects[end.instance];
        if (has_points_ || !std::isfinite(ray.t_max)) return &kNoSurface;
        return lit_instances_.size() == 1 ? &names_.objects[*lit_instances_.begin()] : nullptr;
    }

    const World& world_;
    const SceneHitNames& names_;
    std::set<std::uint32_t> lit_instances_;  ///< instances that are lights
    bool has_points_ = false;                ///< there are lights without a surface that are not infinitely far away
    std::vector<Hit> hits_;
    std::vector<Ray> ends_;
    std::vector<std::uint8_t> blocked_;
    std::map<std::string, double> objects_;
    std::map<std::string, double> materials_;
    std::map<std::string, double> textures_;
    std::map<std::string, LampReport> lamps_;
};

}  // namespace

SceneHitNames scene_names(const SceneDesc& scene) {
    SceneHitNames names{.objects = object_names(scene), .materials = material_names(scene), .textures = {}};
    for (const MaterialDesc& material : scene.materials) {
        std::set<std::string> textures;
        for_each_texture(material, [&](const TextureRef& texture, std::string_view) {
            if (!texture.valid()) return;
            const std::int32_t image = scene.textures[static_cast<std::size_t>(texture.texture.index)].image.index;
            if (image < 0) return;
            const ImageDesc& of_texture = scene.images[static_cast<std::size_t>(image)];
            textures.insert(!of_texture.name.empty()   ? of_texture.name
                            : !of_texture.path.empty() ? of_texture.path.filename().string()
                                                       : fmt::format("image {}", image));
        });
        names.textures.emplace_back(textures.begin(), textures.end());
    }
    return names;
}

SceneHitsReport count_scene_hits(const World& world, const SceneHitNames& names, const WaveProfile& profile,
                                 const RaysByKind& rays) {
    HitCounter counter(world, names);
    for (std::size_t i = 0; i < kRayKinds; ++i) {
        const auto kind = static_cast<RayKind>(i);
        const RayRecorder& recorder = profile.recorder(kind);
        if (recorder.ray_count() == 0) continue;
        const double weight = static_cast<double>(rays[kind]) / static_cast<double>(recorder.ray_count());
        for (const std::vector<Ray>& segment : recorder.segments()) {
            if (kind == RayKind::Shadow) counter.add_shadow(segment, weight);
            if (!asks_for_occlusion(kind)) counter.add_nearest(segment, weight);
        }
    }
    return counter.report();
}

}  // namespace etendue
