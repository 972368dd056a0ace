// What the camera sees of a shadow catcher: the shadow alone, before the environment where it sees that, and else as
// alpha.
#pragma once

#include "wave/ray_batch.h"

namespace etendue {

/// Holds what the eye sees of a shadow catcher in place of the surface.
struct SeenShadow {
    float environment = 0.0f;  ///< share of the environment that shows, [0, 1]; 0 if the camera sees none
    float alpha = 1.0f;        ///< alpha of the sample, [0, 1]
    std::uint32_t rays = 0;    ///< shadow rays that were traced
};

/// Returns what the camera sees where `ray`, of the sample of `key`, has met a shadow catcher at `hit`.
[[nodiscard]] SeenShadow seen_shadow(const World& world, const TileJob& job, const Ray& ray, const Hit& hit,
                                     const SampleKey& key, RenderCounters& counters);

}  // namespace etendue
