// The rays of scalar algorithms that stand for one kind of a wide integrator's rays.
#pragma once

#include "transport/shadow_catcher.h"
#include "transport/walk.h"
#include "wave/aov/sample_light.h"
#include "wave/profile/wave_profile.h"
#include "wave/ray_batch.h"
#include "wave/render_counters.h"

namespace etendue {

/// Traces rays one by one and counts those that look for the nearest surface as of one kind.
class OneKindTracer : public SampleTracer {
  public:
    OneKindTracer(const World& world, const TileJob& job, RayKind kind, RenderCounters& counters)
        : world_(world), job_(job), kind_(kind), counters_(counters) {}

    [[nodiscard]] Hit nearest_hit(const Ray& ray, int /*number*/, RayEnds ends) override {
        return intersect_one(world_, job_, ends == RayEnds::AtCamera ? RayKind::Primary : kind_, ray, counters_);
    }
    [[nodiscard]] std::uint8_t occluded(const Ray& ray) override {
        return occluded_one(world_, job_, RayKind::Shadow, ray, counters_);
    }

  private:
    const World& world_;
    const TileJob& job_;
    RayKind kind_;
    RenderCounters& counters_;
};

/// Returns what the camera sees in the place of the surface that `ray`, within `interior`, has met at `hit`. Shadow
/// rays use the random numbers of the sample with `key`, and are counted in `slot` of `light`.
[[nodiscard]] inline SeenInPlace trace_seen_in_place(const World& world, const TileJob& job, const Ray& ray,
                                                     const Interior& interior, const Hit& hit, SampleKey key,
                                                     std::uint32_t slot, SampleLight& light, RenderCounters& counters) {
    OneKindTracer tracer(world, job, RayKind::Shadow, counters);
    const SeenInPlace seen =
        seen_in_place(world, world.geometry().surface_point(hit), ray, interior, {job.sequence, key}, &tracer);
    for (std::uint32_t i = 0; i < seen.rays; ++i) light.count_ray(slot);
    if (job.profile != nullptr) job.profile->use().light_samples += seen.rays;
    return seen;
}

}  // namespace etendue
