// Rays that ask whether two points see each other.
#pragma once

#include "core/ray.h"
#include "light/light_sample.h"

#include <cmath>
#include <limits>

namespace etendue {

/// From `origin` to just before `end`; both are clear of their surfaces.
[[nodiscard]] inline Ray connecting_ray(const Vec3f& origin, const Vec3f& end) {
    // What rounding may add to the length; the end is clear of its surface by more than its own rounding.
    constexpr float kBeforeEnd = 1.0f - 8.0f * std::numeric_limits<float>::epsilon();
    Ray ray;
    ray.origin = origin;
    const Vec3f to_end = end - origin;
    const float distance = length(to_end);
    if (distance > 0.0f) ray.direction = to_end * (1.0f / distance);
    ray.t_max = distance * kBeforeEnd;
    return ray;
}

/// From a point to where the light was sampled; the end is clear of the surface there.
[[nodiscard]] inline Ray shadow_ray(const Vec3f& origin, const LightSample& light) {
    if (!std::isinf(light.distance)) return connecting_ray(origin, light.end);
    Ray ray;
    ray.origin = origin;
    ray.direction = light.wi;
    return ray;
}

}  // namespace etendue
