// How a complete path leaves its light.
#pragma once

#include "integrator/bdpt/complete_path.h"

namespace etendue::test {

/// Returns the ray with which `path` leaves its light.
[[nodiscard]] inline EmittedRay emitted_ray(const World& world, const CompletePath& path) {
    const PathLightEnd& end = path.end;
    const bool at_infinity = end.light != kNone && world.lights().is_at_infinity(end.light);
    return {.light = end.light,
            .triangle = end.triangle,
            .point = at_infinity ? path.inner.front()->position : end.position,
            .direction = end.direction,
            .cos_light = end.cos_light,
            .time = end.time};
}

}  // namespace etendue::test
