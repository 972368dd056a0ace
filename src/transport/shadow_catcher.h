// Shadow catchers: surfaces of which the camera sees how much light is taken from them, and no more.
#pragma once

#include "sampling/sampler.h"
#include "transport/dimensions.h"
#include "transport/sample_tracer.h"
#include "world/world.h"

#include <cstdint>

namespace etendue {

/// Counts the samples of the lamps and of the environment that each sample of a pixel takes where it meets a catcher.
inline constexpr std::uint32_t kCatcherSamples = 16;

/// Holds what a sample of a pixel finds of the shadow on a catcher.
struct CaughtShadow {
    float share = 0.0f;      ///< share of the direct light that surfaces take, in [0, 1]
    std::uint32_t rays = 0;  ///< shadow rays that were traced
};

/// Returns the share that surfaces take of the direct light that would arrive at `point` without them, on the side of
/// `wo`: 1 less the irradiance with surfaces over that without. Both are estimated from one set of samples, which goes
/// on for a while if it finds no light; where no light would arrive, the share is 0. `tracer` traces the rays; null if
/// the World does.
[[nodiscard]] CaughtShadow caught_shadow(const World& world, const SurfacePoint& point, const Vec3f& wo, float time,
                                         const SampleNumbers& numbers, SampleTracer* tracer = nullptr);

}  // namespace etendue
