// Shadow catchers and holdouts: the camera sees only the shadow on a catcher, and a hole in the place of a holdout.
#pragma once

#include "sampling/sampler.h"
#include "transport/dimensions.h"
#include "transport/walk.h"
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

/// Returns the share that surfaces and media take of the direct light that would arrive at `point` without them, on the
/// side that `ray` comes from within `interior`: 1 less the irradiance with them over that without. Both are estimated
/// from one set of samples, which goes on for a while if it finds no light; where no light would arrive, the share is
/// 0. `tracer` traces the rays; null if the World does.
[[nodiscard]] CaughtShadow caught_shadow(const World& world, const SurfacePoint& point, const Ray& ray,
                                         const Interior& interior, const SampleNumbers& numbers,
                                         SampleTracer* tracer = nullptr);

/// Returns the alpha of a sample that sees what lies behind the whole scene through `throughput`.
[[nodiscard]] inline float alpha_over_background(const Rgb& throughput) {
    return average(Rgb(1.0f) - throughput);
}

/// Holds what the camera sees in the place of a surface.
struct SeenInPlace {
    float passed = 0.0f;     ///< share of what lies behind the whole scene that shows, [0, 1]
    bool is_hole = false;    ///< true if nothing lies there: the sample's alpha lacks what would come through
    std::uint32_t rays = 0;  ///< shadow rays that were traced
};

/// Returns what the camera sees where `ray`, within `interior`, has met a surface at `point` that it does not see.
[[nodiscard]] SeenInPlace seen_in_place(const World& world, const SurfacePoint& point, const Ray& ray,
                                        const Interior& interior, const SampleNumbers& numbers,
                                        SampleTracer* tracer = nullptr);

}  // namespace etendue
