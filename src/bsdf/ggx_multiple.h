// Directions for light that scattered several times on a GGX surface.
//
// That lobe is proportional to (1 - E(mu)) mu, and 1 - E falls about as 1 / (mu² + b²) with b = 2 alpha: it is at
// grazing angles that light is lost. So mu has the density 2 mu / ((mu² + b²) ln(1 + 1/b²)), whose distribution
// function ln(1 + mu²/b²) / ln(1 + 1/b²) inverts in closed form. The lobe over the density stays below 3 for every
// alpha and index, but for 20 about the critical angle of surfaces with alpha below 0.02, which lose less than a
// thousandth in all; over the cosine's density it reaches 10⁴ on nearly smooth surfaces.
#pragma once

#include "core/trigonometry.h"
#include "core/vec.h"

namespace etendue {

/// A template of its lane type, see core/lane.h.
template <typename T>
struct BasicGgxMultiple {
    T b_squared;
    T log_range;

    explicit BasicGgxMultiple(T alpha) : b_squared(4.0f * alpha * alpha), log_range(log(1.0f + 1.0f / b_squared)) {}

    /// Density of `sample`, 1/sr, for a direction with cosine `cos_theta` >= 0.
    [[nodiscard]] T pdf_solid_angle(T cos_theta) const {
        return kInvPi * cos_theta / ((cos_theta * cos_theta + b_squared) * log_range);
    }

    /// A direction with z >= 0.
    [[nodiscard]] Imath::Vec3<T> sample(const Imath::Vec2<T>& u) const {
        const T cos2 = min(T(1.0f), b_squared * expm1(u.y * log_range));
        const T sine = sqrt(1.0f - cos2);
        const BasicSinCos<T> phi = sin_cos_turns(u.x);
        return {sine * phi.cos, sine * phi.sin, sqrt(cos2)};
    }
};
using GgxMultiple = BasicGgxMultiple<float>;

}  // namespace etendue
