// Whether a partly transparent surface stops a ray.
#pragma once

#include "sampling/hash.h"
#include "world/hit.h"

#include <cstdint>

namespace etendue {

/// Decides with the probability `opacity`, [0, 1], whether the surface at `hit` stops a ray. The decision is a hash of
/// the ray's key and the triangle, so that a ray decides the same way however often it is asked, and by whom.
[[nodiscard]] inline bool stops_ray(std::uint32_t alpha_key, const Hit& hit, float opacity) {
    const std::uint32_t bits =
        hash_combine(hash_combine(hash_combine(alpha_key, hit.instance), hit.geometry), hit.triangle);
    return to_unit_float(bits) < opacity;
}

}  // namespace etendue
