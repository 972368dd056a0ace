// How the slopes of a surface are spread where a normal map is read over more than a texel.
//
// A normal (x, y, z) of tangent space has the slope (x / z, y / z). Its mean and covariance over a footprint say what a
// normal alone cannot: how rough the relief is that the footprint averages (Olano and Baker, "LEAN Mapping", I3D 2010).
#pragma once

#include "core/rgb.h"
#include "core/vec.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace etendue {

/// The symmetric matrix of the second moments of slopes about their mean, along the tangent (x) and the bitangent (y).
struct SlopeCovariance {
    float xx = 0.0f;
    float xy = 0.0f;
    float yy = 0.0f;

    [[nodiscard]] bool is_zero() const { return xx == 0.0f && yy == 0.0f; }
    [[nodiscard]] float trace() const { return xx + yy; }
};

struct SlopeDistribution {
    Vec2f mean{0.0f, 0.0f};
    SlopeCovariance covariance{};
};

/// The distribution that takes the share 1 - `t` of its slopes from `a` and `t` from `b`: the means' own spread adds to
/// what each has.
[[nodiscard]] inline SlopeDistribution mix(const SlopeDistribution& a, const SlopeDistribution& b, float t) {
    const Vec2f apart = b.mean - a.mean;
    const float between = t * (1.0f - t);
    const auto moment = [&](float of_a, float of_b, float product) {
        return of_a + (of_b - of_a) * t + between * product;
    };
    return {a.mean + apart * t,
            {moment(a.covariance.xx, b.covariance.xx, apart.x * apart.x),
             moment(a.covariance.xy, b.covariance.xy, apart.x * apart.y),
             moment(a.covariance.yy, b.covariance.yy, apart.y * apart.y)}};
}

/// Longest slope that counts: 76 degrees. Fewer, steeper ones would make all that is around them as rough as can be.
inline constexpr float kSteepestSlope = 4.0f;

/// The slope of the normal that a texel of a normal map holds, its components in [-1, 1] stored as [0, 1]. A normal
/// that points into the surface has none: there the map is flat.
[[nodiscard]] inline Vec2f slope_of(const Rgb& texel) {
    const Vec3f normal(2.0f * texel.r - 1.0f, 2.0f * texel.g - 1.0f, 2.0f * texel.b - 1.0f);
    if (!(normal.z > 1e-3f * length(normal))) return {0.0f, 0.0f};
    const Vec2f slope(normal.x / normal.z, normal.y / normal.z);
    const float squared = slope.x * slope.x + slope.y * slope.y;
    constexpr float kMost = kSteepestSlope * kSteepestSlope;
    return squared > kMost ? slope * (kSteepestSlope / std::sqrt(squared)) : slope;
}

/// The means of x, y, x², xy and y²: unlike covariances, they are averaged number by number.
using SlopeMoments = std::array<float, 5>;

[[nodiscard]] inline SlopeMoments moments_of(Vec2f slope) {
    return {slope.x, slope.y, slope.x * slope.x, slope.x * slope.y, slope.y * slope.y};
}

[[nodiscard]] inline SlopeDistribution distribution_of(const SlopeMoments& m) {
    // Less than this share of the moments is the rounding of a constant slope.
    constexpr float kRounding = 1e-6f;
    const SlopeCovariance covariance{m[2] - m[0] * m[0], m[3] - m[0] * m[1], m[4] - m[1] * m[1]};
    const bool is_constant = !(covariance.trace() > kRounding * (m[2] + m[4]));
    if (is_constant) return {{m[0], m[1]}, {}};
    return {{m[0], m[1]}, {std::max(0.0f, covariance.xx), covariance.xy, std::max(0.0f, covariance.yy)}};
}

}  // namespace etendue
