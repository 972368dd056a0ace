// What the camera sees in the place of a surface: of a shadow catcher the shadow alone, before the environment where it
// sees that and else as alpha; of a holdout nothing.
#pragma once

#include "wave/ray_batch.h"

namespace etendue {

/// Holds what the camera sees in the place of a surface.
struct SeenInPlace {
    float environment = 0.0f;  ///< share of the environment that shows, [0, 1]; 0 if the camera sees none
    float alpha = 1.0f;        ///< alpha of the sample, [0, 1]
    std::uint32_t rays = 0;    ///< shadow rays that were traced
};

/// Returns what the camera sees where `ray`, of the sample of `key`, has met a surface that it does not see, at `hit`.
[[nodiscard]] SeenInPlace seen_in_place(const World& world, const TileJob& job, const Ray& ray, const Hit& hit,
                                        const SampleKey& key, RenderCounters& counters);

}  // namespace etendue
