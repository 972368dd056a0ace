#include "profile/scene_hits.h"

#include "picture/matte_names.h"
#include "scene/material_textures.h"
#include "world/scattering.h"

#include <algorithm>
#include <chrono>
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

/// Lists hits and seconds by name, the most seconds first.
std::vector<HitsReport> sorted_by_time(const std::map<std::string, HitsReport>& found) {
    std::vector<HitsReport> list;
    list.reserve(found.size());
    for (const auto& [name, hits] : found) list.push_back({name, hits.hits, hits.seconds});
    std::ranges::stable_sort(list, std::ranges::greater{}, &HitsReport::seconds);
    return list;
}

/// Holds a ray and what it has met.
struct RecordedHit {
    Ray ray;
    Hit hit;
};

/// Finds the point that `recorded` has met, samples how light scatters there, and evaluates that; returns a number that
/// depends on all of it.
float shade(const World& world, const RecordedHit& recorded, Vec2f u) {
    const SurfacePoint point = world.geometry().surface_point(recorded.hit, recorded.ray, RayCone{});
    if (point.material->unlit) return world.materials().unlit_color(point).g;
    const Vec3f wo = -recorded.ray.direction;
    Bsdf storage;
    const Bsdf& bsdf = world.materials().bsdf(point, wo, 0.0f, storage);
    const Scattering scattering(bsdf, point.shading, point.geometric_normal, wo);
    const BsdfSample sample = scattering.sample(u.x, u, TransportMode::Radiance);
    return sample.weight.g + scattering.evaluate(sample.wi, TransportMode::Radiance).f_cos.g;
}

/// Returns the seconds that one thread takes to shade one of `hits`, which is not empty: the best of a few tries.
double seconds_to_shade(const World& world, const std::vector<RecordedHit>& hits) {
    constexpr int kTries = 3;
    constexpr std::size_t kShaded = 512;  // in each try
    using Clock = std::chrono::steady_clock;
    double best = std::numeric_limits<double>::infinity();
    float sum = 0.0f;
    for (int i = 0; i < kTries; ++i) {
        const Clock::time_point start = Clock::now();
        for (std::size_t k = 0; k < kShaded; ++k) {
            const float u = (static_cast<float>(k) + 0.5f) / kShaded;
            sum += shade(world, hits[k % hits.size()], {u, 1.0f - u});
        }
        best = std::min(best, std::chrono::duration<double>(Clock::now() - start).count());
    }
    volatile float used = sum;  // or else the compiler might leave all of it out
    static_cast<void>(used);
    return best / kShaded;
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

    /// Adds rays that look for the nearest surface. Each stands for `weight` rays, which took `seconds`.
    void add_nearest(const std::vector<Ray>& rays, double weight, double seconds) {
        constexpr std::size_t kMostKept = 512;
        hits_.resize(rays.size());
        world_.geometry().intersect(rays, hits_, Coherence::Incoherent);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const Hit& hit = hits_[i];
            if (!hit.valid()) continue;
            HitsReport& object = objects_[names_.objects[hit.instance]];
            object.hits += weight;
            object.seconds += seconds;
            const std::uint32_t material = world_.materials().index(hit);
            met_[{hit.instance, material}] += weight;
            std::vector<RecordedHit>& kept = of_material_[material];
            if (kept.size() < kMostKept) kept.push_back({rays[i], hit});
        }
    }

    /// Adds shadow rays. Each stands for `weight` rays, which took `seconds`.
    void add_shadow(const std::vector<Ray>& rays, double weight, double seconds) {
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
            lamp.seconds += seconds;
            if (blocked_[i] == kOccluded) lamp.blocked += weight;
        }
    }

    /// Shares out the seconds of the stages in `clock`.
    [[nodiscard]] SceneHitsReport report(const StageClock& clock) const {
        std::map<std::uint32_t, double> cost;
        for (const auto& [material, hits] : of_material_) cost[material] = seconds_to_shade(world_, hits);
        double all = 0.0;
        double on_textures = 0.0;
        for (const auto& [met, hits] : met_) {
            all += hits * cost.at(met.second);
            on_textures += hits * static_cast<double>(names_.textures[met.second].size());
        }
        const double of_textures = clock.seconds(Stage::Textures);
        const double shading = clock.seconds(Stage::HitSetup) + of_textures + clock.seconds(Stage::Material);
        std::map<std::string, HitsReport> materials;
        std::map<std::string, HitsReport> textures;
        std::map<std::string, HitsReport> objects = objects_;
        for (const auto& [met, hits] : met_) {
            const auto& [instance, material] = met;
            const double seconds = shading * hits * cost.at(material) / all;
            objects[names_.objects[instance]].seconds += seconds;
            HitsReport& of_material = materials[names_.materials[material]];
            of_material.hits += hits;
            of_material.seconds += seconds;
            for (const std::string& texture : names_.textures[material]) {
                textures[texture].hits += hits;
                textures[texture].seconds += of_textures * hits / on_textures;
            }
        }
        SceneHitsReport report{.materials = sorted_by_time(materials),
                               .objects = sorted_by_time(objects),
                               .textures = sorted_by_time(textures)};
        report.lamps.reserve(lamps_.size());
        for (const auto& [name, lamp] : lamps_)
            report.lamps.push_back({name, lamp.shadow_rays, lamp.blocked, lamp.seconds});
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
    std::map<std::string, HitsReport> objects_;                      ///< with the seconds of tracing alone
    std::map<std::pair<std::uint32_t, std::uint32_t>, double> met_;  ///< hits by instance and material
    std::map<std::uint32_t, std::vector<RecordedHit>> of_material_;  ///< some hits of each
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
        const auto recorded = static_cast<double>(recorder.ray_count());
        const double weight = static_cast<double>(rays[kind]) / recorded;
        const double seconds = profile.clock().seconds(kind) / recorded;
        for (const std::vector<Ray>& segment : recorder.segments()) {
            if (kind == RayKind::Shadow) counter.add_shadow(segment, weight, seconds);
            if (!asks_for_occlusion(kind)) counter.add_nearest(segment, weight, seconds);
        }
    }
    return counter.report(profile.clock());
}

}  // namespace etendue
