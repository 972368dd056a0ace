// What is asked of the World: rays, and the key that makes stochastic transparency repeatable.
#pragma once

#include "core/vec.h"

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
    float time = 0.0f;  ///< from the shutter's opening, 0, to its closing, 1
};
static_assert(sizeof(Ray) == 36);

/// The point `distance` metres off the surface at `p`, on the side of the unit geometric normal `n` towards which
/// `direction` points.
template <typename T>
[[nodiscard]] inline Imath::Vec3<T> offset_origin(const Imath::Vec3<T>& p, const Imath::Vec3<T>& n, T distance,
                                                  const Imath::Vec3<T>& direction) {
    return p + n * select(dot(n, direction) >= T(0.0f), distance, -distance);
}

}  // namespace etendue
