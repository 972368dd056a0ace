#include "world/accelerated_scene.h"

#include "core/error.h"
#include "core/position_error.h"
#include "core/process_time.h"
#include "world/embree_scene.h"
#include "world/material_evaluation.h"
#include "world/stochastic_opacity.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Throws SceneError if nothing but Embree can be built over `data`.
void require_still_and_small(const WorldData& data) {
    const auto refuse = [](const std::string& reason) {
        throw SceneError({}, "accelerators beside Embree cannot have this scene: " + reason);
    };
    const bool has_motion = !data.motions.empty() || std::ranges::any_of(data.geometries, [](const Geometry& geometry) {
        return !geometry.motion.empty();
    });
    if (has_motion) refuse("something moves while the shutter is open");
    if (std::ranges::any_of(data.materials, &Material::culls_back))
        refuse("back faces are invisible (--cull-backfaces)");
    std::size_t triangles = 0;
    for (const Instance& instance : data.instances)
        for (std::uint32_t g = 0; g < instance.geometry_count; ++g)
            triangles += data.geometries[instance.first_geometry + g].triangles.size();
    if (triangles > AcceleratedScene::kMostTriangles)
        refuse(fmt::format("with each instance counted there are {} triangles, and {} is the most", triangles,
                           AcceleratedScene::kMostTriangles));
}

bool lets_pass(const Material& material) {
    return material.alpha_test != AlphaTest::Opaque || material.is_clear || !material.visible_to_camera;
}

}  // namespace

/// Lets a ray pass what Embree's filter functions let it pass.
class AcceleratedScene::Filter final : public TriangleFilter {
  public:
    Filter(const AcceleratedScene& scene, const Ray& ray, RayEnds ends, bool passes_clear)
        : scene_(scene), ray_(ray), ends_(ends), passes_clear_(passes_clear) {}

    [[nodiscard]] bool stops(const TriangleHit& met) override { return stops(scene_.make_hit(met, ray_.time)); }
    [[nodiscard]] bool stops(const Hit& hit) {
        const WorldData& data = scene_.data_;
        const Material& material = data.materials[data.geometries[hit.geometry].material];
        if (has_end_at_camera(ends_) && !material.visible_to_camera) return false;
        if (material.alpha_test != AlphaTest::Opaque &&
            !stops_ray(ray_.alpha_key, hit, evaluate_opacity(data, hit.geometry, hit.triangle, {hit.u, hit.v})))
            return false;
        if (!passes_clear_ || !material.is_clear) return true;
        has_passed_clear = true;
        return false;
    }

    bool has_passed_clear = false;

  private:
    const AcceleratedScene& scene_;
    const Ray& ray_;
    RayEnds ends_;
    bool passes_clear_;
};

AcceleratedScene::AcceleratedScene(const WorldData& data, AcceleratorKind kind) : data_(data) {
    require_still_and_small(data);
    for (std::uint32_t i = 0; i < data.instances.size(); ++i) {
        const Instance& instance = data.instances[i];
        for (std::uint32_t g = 0; g < instance.geometry_count; ++g) {
            const Geometry& geometry = data.geometries[instance.first_geometry + g];
            has_filters_ = has_filters_ || lets_pass(data.materials[geometry.material]);
            if (geometry.shape)
                shapes_.push_back({geometry.shape->placed(instance.to_world), i, instance.first_geometry + g});
            const auto corner = [&](std::uint32_t vertex) {
                const Vec3f& p = geometry.positions[vertex];
                return instance.baked ? p : transform_point(instance.to_world, p);
            };
            for (std::uint32_t t = 0; t < geometry.triangles.size(); ++t) {
                const auto& [a, b, c] = geometry.triangles[t];
                triangles_.push_back({corner(a), corner(b), corner(c)});
                identities_.push_back({i, instance.first_geometry + g, t});
            }
        }
    }
    accelerator_ = build_accelerator(kind, triangles_);
}

Hit AcceleratedScene::make_hit(const TriangleHit& hit, float time) const {
    if (!hit.valid()) return {};
    const Identity& identity = identities_[hit.triangle];
    return {hit.t, hit.u, hit.v, identity.triangle, identity.geometry & 0x7fffffffu, 0, identity.instance, time};
}

Hit AcceleratedScene::closest(const Ray& ray, RayEnds ends, RayWork& work) const {
    Filter filter(*this, ray, ends, false);
    const Hit hit = make_hit(accelerator_->closest_hit(ray, has_filters_ ? &filter : nullptr, work), ray.time);
    if (shapes_.empty()) return hit;
    const Hit on_shape = closest_shape(ray, hit.valid() ? hit.t : ray.t_max, filter, work);
    return on_shape.valid() ? on_shape : hit;
}

Hit AcceleratedScene::closest_shape(const Ray& ray, float t_max, Filter& filter, RayWork& work) const {
    work.triangles += shapes_.size();
    Hit nearest;
    for (const auto& [shape, instance, geometry] : shapes_) {
        const ShapeCrossings crossings = shape.crossings(ray.origin, ray.direction);
        for (std::size_t c = 0; c < crossings.count; ++c) {
            const ShapeCrossing& crossing = crossings.all[c];
            const auto t = static_cast<float>(crossing.t);
            if (!(t > 0.0f && t <= (nearest.valid() ? nearest.t : t_max))) continue;
            const Hit hit{t,
                          crossing.place.at.x,
                          crossing.place.at.y,
                          triangle_of_place(crossing.place, crossing.is_from_back),
                          geometry & 0x7fffffffu,
                          0,
                          instance,
                          ray.time};
            if (filter.stops(hit)) nearest = hit;
        }
    }
    return nearest;
}

std::uint8_t AcceleratedScene::occlusion(const Ray& ray, RayEnds ends, RayWork& work) const {
    Filter filter(*this, ray, ends, true);
    if (accelerator_->any_hit(ray, has_filters_ ? &filter : nullptr, work)) return kOccluded;
    if (!shapes_.empty() && closest_shape(ray, ray.t_max, filter, work).valid()) return kOccluded;
    return filter.has_passed_clear ? kPassesClear : kFree;
}

double AcceleratedScene::replay(std::span<const Ray> rays, bool occlusion, RayWork& work) const {
    // Something has to be done with the answers, or there would be no need to find them.
    std::size_t met = 0;
    const auto start = std::chrono::steady_clock::now();
    for (const Ray& ray : rays)
        met += occlusion ? this->occlusion(ray, RayEnds::InScene, work) == kOccluded
                         : closest(ray, RayEnds::InScene, work).valid();
    const double seconds = seconds_since(start);
    return met <= rays.size() ? seconds : 0.0;
}

HitAgreement AcceleratedScene::compare_with_embree(std::span<const Ray> rays, bool occlusion) const {
    HitAgreement agreement{.rays = rays.size()};
    if (occlusion) {
        std::vector<std::uint8_t> theirs(rays.size());
        data_.bvh->occluded(rays, theirs, QueryForm::Best);
        for (std::size_t i = 0; i < rays.size(); ++i)
            agreement.differ += this->occlusion(rays[i], RayEnds::InScene) != theirs[i];
        return agreement;
    }
    std::vector<Hit> theirs(rays.size());
    data_.bvh->intersect(rays, theirs, Coherence::Incoherent, QueryForm::Best);
    const Vec3f extent = max_components(abs_components(data_.bounds.min), abs_components(data_.bounds.max));
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Hit ours = closest(rays[i], RayEnds::InScene);
        if (ours.valid() != theirs[i].valid()) {
            ++agreement.differ;
            continue;
        }
        if (!ours.valid()) continue;
        const double scale = static_cast<double>(std::max(max_abs(extent), max_abs(rays[i].origin)));
        const double error = std::abs(static_cast<double>(ours.t) - static_cast<double>(theirs[i].t)) / scale;
        const bool is_same = ours.instance == theirs[i].instance && ours.geometry == theirs[i].geometry &&
                             ours.triangle == theirs[i].triangle;
        if (is_same)
            agreement.largest_error = std::max(agreement.largest_error, error);
        else if (error <= static_cast<double>(kPositionError))
            ++agreement.ties;
        else
            ++agreement.differ;
    }
    return agreement;
}

}  // namespace etendue
