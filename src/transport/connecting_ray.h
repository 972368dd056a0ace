// Rays that ask whether two points see each other.
#pragma once

#include "core/ray.h"
#include "light/light_sample.h"

#include <cmath>
#include <limits>

namespace etendue {

/// Holds a ray between two points; a template of its lane type, see core/lane.h.
template <typename T>
struct ConnectingRay {
    Imath::Vec3<T> direction;  ///< unit; any if there is no distance
    T t_max;                   ///< metres

    /// Leads from `origin` to just before `end`; both are clear of their surfaces.
    ConnectingRay(const Imath::Vec3<T>& origin, const Imath::Vec3<T>& end) : direction(end - origin) {
        // What rounding may add to the length; the end is clear of its surface by more than its own rounding.
        constexpr float kBeforeEnd = 1.0f - 8.0f * std::numeric_limits<float>::epsilon();
        const T distance = length(direction);
        const auto apart = distance > T(0.0f);
        const T scale = select(apart, 1.0f / distance, T(0.0f));
        direction = {direction.x * scale, direction.y * scale, select(apart, direction.z * scale, T(1.0f))};
        t_max = distance * kBeforeEnd;
    }
};

/// Returns the ray of a `ConnectingRay` from `origin` to `end`.
[[nodiscard]] inline Ray connecting_ray(const Vec3f& origin, const Vec3f& end) {
    const ConnectingRay<float> connection(origin, end);
    Ray ray;
    ray.origin = origin;
    ray.direction = connection.direction;
    ray.t_max = connection.t_max;
    return ray;
}

/// Returns the ray from `origin` to where `light` was sampled; its end is clear of the surface there.
[[nodiscard]] inline Ray shadow_ray(const Vec3f& origin, const LightSample& light) {
    if (!std::isinf(light.distance)) return connecting_ray(origin, light.end);
    Ray ray;
    ray.origin = origin;
    ray.direction = light.wi;
    return ray;
}

}  // namespace etendue
