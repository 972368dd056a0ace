// The rays of scalar algorithms that stand for one kind of a wide integrator's rays.
#pragma once

#include "transport/sample_tracer.h"
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

}  // namespace etendue
