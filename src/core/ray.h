// What is asked of the World: rays, and the key that makes stochastic transparency repeatable.
#pragma once

#include "core/vec.h"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace etendue {

/// A ray from `origin` (metres) along the unit vector `direction` over distances (0, t_max]. Origins are moved off the
/// surface they start on (see `offset_origin`), so there is no t_min.
struct Ray {
    Vec3f origin{0.0f};
    /// Random bits that decide, together with the surface's identity, whether a partly transparent surface stops this
    /// ray. Derived from (seed, pixel, sample, dimension), so that a ray always decides the same way.
    std::uint32_t alpha_key = 0;
    Vec3f direction{0.0f, 0.0f, 1.0f};
    float t_max = std::numeric_limits<float>::infinity();
};
static_assert(sizeof(Ray) == 32);

/// A point just off the surface at `p`, on the side of the unit geometric normal `n` towards which `direction` points.
///
/// The distance is a few units in the last place of the largest coordinate, which bounds the error of a hit point
/// interpolated from its triangle (Waechter and Binder, "A Fast and Robust Method for Avoiding Self-Intersection",
/// Ray Tracing Gems, 2019, chapter 6).
[[nodiscard]] inline Vec3f offset_origin(const Vec3f& p, const Vec3f& n, const Vec3f& direction) {
    constexpr float kUlps = 64.0f * std::numeric_limits<float>::epsilon() / 2.0f;
    constexpr float kSmallest = 1.0f / 65536.0f;
    const float extent = std::max(kSmallest * 16.0f, std::max(std::abs(p.x), std::max(std::abs(p.y), std::abs(p.z))));
    const float distance = extent * kUlps;
    return p + n * (dot(n, direction) >= 0.0f ? distance : -distance);
}

}  // namespace etendue
