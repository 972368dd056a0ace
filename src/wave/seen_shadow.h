// What the camera sees of a shadow catcher: the shadow alone, before the environment where it sees that, and else as
// alpha.
#pragma once

#include "wave/ray_batch.h"

namespace etendue {

/// Holds what an eye path that meets a shadow catcher brings back, in place of the surface's light.
struct SeenShadow {
    float environment =
        0.0f;            ///< share of what a ray that meets nothing sees, [0, 1]; 0 if the camera sees nothing there
    float alpha = 1.0f;  ///< of the sample
    std::uint32_t rays = 0;  ///< traced to lights
};

/// Returns what the camera sees where `ray`, of the sample of `key`, has met a shadow catcher at `hit`.
[[nodiscard]] SeenShadow seen_shadow(const World& world, const TileJob& job, const Ray& ray, const Hit& hit,
                                     const SampleKey& key, RenderCounters& counters);

}  // namespace etendue
