// How far rounding may have moved a point of a surface, and with it how far a ray must start from that surface.
//
// A point interpolated from a triangle, and the distance at which Embree meets the triangle, are sums of products of
// the triangle's coordinates: their errors grow with the largest coordinate of its vertices on each axis, not with
// those of the point (Pharr, Jakob and Humphreys, Physically Based Rendering, 4th edition, section 6.8). Meshes that
// are placed by a transform meet rays in their own space, so what counts there is the size of every term of it.
#pragma once

#include "core/vec.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace etendue {

/// Relative error of the sums involved: 16 roundings.
inline constexpr float kPositionError = 16.0f * 0.5f * std::numeric_limits<float>::epsilon();

[[nodiscard]] inline Vec3f abs_components(const Vec3f& v) {
    return {std::abs(v.x), std::abs(v.y), std::abs(v.z)};
}
[[nodiscard]] inline Vec3f max_components(const Vec3f& a, const Vec3f& b) {
    return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

/// Error per axis, metres, of points between vertices whose coordinates are at most `extent` from zero.
[[nodiscard]] inline Vec3f position_error(const Vec3f& extent) {
    return extent * kPositionError;
}

/// The same after the transform `m` from mesh to world space; `extent` is in mesh space.
[[nodiscard]] inline Vec3f position_error(const Vec3f& extent, const Mat4f& m) {
    Vec3f error;
    for (int i = 0; i < 3; ++i) {
        const float terms = std::abs(m[0][i]) * extent.x + std::abs(m[1][i]) * extent.y + std::abs(m[2][i]) * extent.z;
        error[i] = kPositionError * (2.0f * terms + std::abs(m[3][i]));
    }
    return error;
}

/// Distance along the unit normal `n`, metres, that clears an error per axis. Not zero: a ray that starts exactly in a
/// surface must not meet it.
[[nodiscard]] inline float clearance(const Vec3f& n, const Vec3f& error) {
    constexpr float kLeast = 1e-9f;
    return std::max(kLeast, dot(abs_components(n), error));
}

}  // namespace etendue
