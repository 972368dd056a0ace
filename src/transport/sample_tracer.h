// How whoever renders takes part in a scalar algorithm: it traces the rays of a sample and counts them.
#pragma once

#include "core/ray.h"
#include "world/world.h"

#include <cstdint>

namespace etendue {

/// Traces the rays of one sample from the eye, one by one.
class SampleTracer {
  public:
    virtual ~SampleTracer() = default;
    /// Returns what `ray` meets first, which has `ends` and is number `number` of its path; 1 comes from the camera.
    [[nodiscard]] virtual Hit nearest_hit(const Ray& ray, int number, RayEnds ends) = 0;
    /// Returns what `SceneGeometry::occluded` says of `ray`.
    [[nodiscard]] virtual std::uint8_t occluded(const Ray& ray) = 0;
    /// Returns true if another estimate finds the emission of `hit`, which the ray from the camera has met.
    [[nodiscard]] virtual bool finds_emission(const Hit& /*hit*/) const { return false; }
};

}  // namespace etendue
