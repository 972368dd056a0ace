// Vectors, matrices and the few functions on them that every room uses. Storage and matrix algebra are Imath's.
#pragma once

#include "core/lane.h"

#include <cmath>

#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

namespace etendue {

using Vec2f = Imath::V2f;
using Vec2i = Imath::V2i;
using Vec3f = Imath::V3f;
using Vec3d = Imath::V3d;
using Vec4f = Imath::V4f;

/// Affine or projective transform with Imath's row-vector convention: p' = p * M, translation in the last row. Its 16
/// floats in memory are those of a column-major column-vector matrix, which is how glTF writes them.
using Mat4f = Imath::M44f;

inline constexpr float kPi = 3.14159265358979323846f;
inline constexpr float kInvPi = 0.31830988618379067154f;

// Templates of their lane type, see core/lane.h; a list in braces is a Vec3f.

template <typename T = float>
[[nodiscard]] inline T dot(const Imath::Vec3<T>& a, const Imath::Vec3<T>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <typename T = float>
[[nodiscard]] inline Imath::Vec3<T> cross(const Imath::Vec3<T>& a, const Imath::Vec3<T>& b) {
    return a.cross(b);
}
template <typename T = float>
[[nodiscard]] inline T length_squared(const Imath::Vec3<T>& v) {
    return dot(v, v);
}
template <typename T = float>
[[nodiscard]] inline T length(const Imath::Vec3<T>& v) {
    return sqrt(length_squared(v));
}

/// Largest absolute value of the components.
template <typename T = float>
[[nodiscard]] inline T max_abs(const Imath::Vec3<T>& v) {
    return max(abs(v.x), max(abs(v.y), abs(v.z)));
}
/// `condition ? if_true : if_false`, lane by lane.
template <typename T = float>
[[nodiscard]] inline Imath::Vec3<T> select(MaskOf<T> condition, const Imath::Vec3<T>& if_true,
                                           const Imath::Vec3<T>& if_false) {
    return {select(condition, if_true.x, if_false.x), select(condition, if_true.y, if_false.y),
            select(condition, if_true.z, if_false.z)};
}
/// `v` scaled to length 1; undefined for a zero vector.
template <typename T = float>
[[nodiscard]] inline Imath::Vec3<T> normalize(const Imath::Vec3<T>& v) {
    return v * (T(1.0f) / length(v));
}
/// Unit normal of the triangle with these two edges, not parallel: counter-clockwise is the front. The edges are scaled
/// first, as the squares of small or large triangles' areas are beyond single precision.
template <typename T = float>
[[nodiscard]] inline Imath::Vec3<T> triangle_normal(const Imath::Vec3<T>& edge1, const Imath::Vec3<T>& edge2) {
    return normalize(cross(edge1 * (T(1.0f) / max_abs(edge1)), edge2 * (T(1.0f) / max_abs(edge2))));
}

template <typename T = float>
[[nodiscard]] inline T abs_dot(const Imath::Vec3<T>& a, const Imath::Vec3<T>& b) {
    return abs(dot(a, b));
}

/// A point through an affine transform.
[[nodiscard]] inline Vec3f transform_point(const Mat4f& m, const Vec3f& p) {
    return {p.x * m[0][0] + p.y * m[1][0] + p.z * m[2][0] + m[3][0],
            p.x * m[0][1] + p.y * m[1][1] + p.z * m[2][1] + m[3][1],
            p.x * m[0][2] + p.y * m[1][2] + p.z * m[2][2] + m[3][2]};
}

/// A direction through an affine transform; its length changes with the transform's scale.
[[nodiscard]] inline Vec3f transform_vector(const Mat4f& m, const Vec3f& v) {
    return {v.x * m[0][0] + v.y * m[1][0] + v.z * m[2][0], v.x * m[0][1] + v.y * m[1][1] + v.z * m[2][1],
            v.x * m[0][2] + v.y * m[1][2] + v.z * m[2][2]};
}

/// A normal through the transform whose inverse is `inverse`: n' = n * transpose(inverse), not normalised.
[[nodiscard]] inline Vec3f transform_normal(const Mat4f& inverse, const Vec3f& n) {
    return {n.x * inverse[0][0] + n.y * inverse[0][1] + n.z * inverse[0][2],
            n.x * inverse[1][0] + n.y * inverse[1][1] + n.z * inverse[1][2],
            n.x * inverse[2][0] + n.y * inverse[2][1] + n.z * inverse[2][2]};
}

[[nodiscard]] inline bool is_finite(const Vec3f& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace etendue
