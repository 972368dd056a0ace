// Shadow catchers: surfaces of which the camera sees how much light is taken from them, and no more.
#pragma once

#include "sampling/sampler.h"
#include "transport/dimensions.h"
#include "world/world.h"

#include <cstdint>

namespace etendue {

/// Counts the samples of the lamps and of the environment that each sample of a pixel takes where it meets a catcher.
inline constexpr std::uint32_t kCatcherSamples = 16;

/// Returns the share, in [0, 1], that surfaces take of the direct light that would arrive at `point` without them, on
/// the side of `wo`: 1 less the irradiance with surfaces over that without. Both are estimated from one set of samples;
/// where no light would arrive, the share is 0.
[[nodiscard]] float caught_shadow(const World& world, const SurfacePoint& point, const Vec3f& wo, float time,
                                  const SampleNumbers& numbers);

}  // namespace etendue
