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

template <typename T = float>
[[nodiscard]] inline Imath::Vec3<T> abs_components(const Imath::Vec3<T>& v) {
    return {abs(v.x), abs(v.y), abs(v.z)};
}
template <typename T = float>
[[nodiscard]] inline Imath::Vec3<T> max_components(const Imath::Vec3<T>& a, const Imath::Vec3<T>& b) {
    return {max(a.x, b.x), max(a.y, b.y), max(a.z, b.z)};
}

/// Error per axis, metres, of points between vertices whose coordinates are at most `extent` from zero.
template <typename T = float>
[[nodiscard]] inline Imath::Vec3<T> position_error(const Imath::Vec3<T>& extent) {
    return extent * T(kPositionError);
}

/// Returns the error per axis, metres, of points that the transform `m` takes from mesh to world space, between
/// vertices whose coordinates in mesh space are at most `extent` from zero.
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
template <typename T = float>
[[nodiscard]] inline T clearance(const Imath::Vec3<T>& n, const Imath::Vec3<T>& error) {
    constexpr float kLeast = 1e-9f;
    return max(T(kLeast), dot(abs_components(n), error));
}

}  // namespace etendue
