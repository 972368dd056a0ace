#include "wave/seen_in_place.h"

#include "transport/shadow_catcher.h"
#include "wave/one_kind_tracer.h"

namespace etendue {

SeenInPlace seen_in_place(const World& world, const TileJob& job, const Ray& ray, const Hit& hit, const SampleKey& key,
                          RenderCounters& counters) {
    if (world.materials().at(hit)->seen_as == SeenAs::Hole) return {.alpha = 0.0f};
    OneKindTracer tracer(world, job, RayKind::Shadow, counters);
    const CaughtShadow caught = caught_shadow(world, world.geometry().surface_point(hit), -ray.direction, ray.time,
                                              {job.sequence, key}, &tracer);
    const bool shows_environment = !world.environment().met(true).empty();
    return {.environment = shows_environment ? 1.0f - caught.share : 0.0f,
            .alpha = shows_environment ? 1.0f : caught.share,
            .rays = caught.rays};
}

}  // namespace etendue
