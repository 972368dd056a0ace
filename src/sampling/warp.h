// Warps of the unit square, with densities where these are asked for.
//
// Notation: `square_to_x(u)` maps u in [0,1)² to the domain x, `x_pdf(p)` is the density of the result in the measure
// that the name states. Sources: Shirley and Chiu, "A Low Distortion Map Between Disk
// and Square" (JGT 2(3), 1997); pbrt, 4th edition, appendix A.5. Some are templates of their lane type, see
// core/lane.h.
#pragma once

#include "core/trigonometry.h"
#include "core/vec.h"

#include <algorithm>
#include <cmath>

namespace etendue {

inline constexpr float kOneMinusEpsilon = 0x1.fffffep-1f;

/// Maps the unit square to the unit disk, concentrically.
template <typename T = float>
[[nodiscard]] inline Imath::Vec2<T> square_to_disk(const Imath::Vec2<T>& u) {
    const T a = 2.0f * u.x - 1.0f;
    const T b = 2.0f * u.y - 1.0f;
    const auto flat = abs(a) > abs(b);
    const T r = select(flat, a, b);
    const T quotient = select(flat, b, a) / select(r == T(0.0f), T(1.0f), r);
    const BasicSinCos<T> angle = sin_cos_octant((kPi / 4.0f) * quotient);
    return {r * select(flat, angle.cos, angle.sin), r * select(flat, angle.sin, angle.cos)};
}

/// Maps the unit square to the regular polygon of so many corners, at least 3, on the unit circle, uniformly; the
/// middle of a side is on the right.
[[nodiscard]] inline Vec2f square_to_regular_polygon(Vec2f u, int corners) {
    const auto count = static_cast<float>(corners);
    const float which = std::min(std::floor(u.x * count), count - 1.0f);
    // Within a triangle from the middle to a side.
    const float from_middle = std::sqrt(u.x * count - which);
    const float along_side = 2.0f * u.y - 1.0f;
    const float half_angle = kPi / count;
    const float x = from_middle * std::cos(half_angle);
    const float y = from_middle * along_side * std::sin(half_angle);
    const float turn = 2.0f * half_angle * which;
    return {std::cos(turn) * x - std::sin(turn) * y, std::sin(turn) * x + std::cos(turn) * y};
}

/// Maps the unit square to the hemisphere around +z, with a density proportional to the cosine.
template <typename T = float>
[[nodiscard]] inline Imath::Vec3<T> square_to_cosine_hemisphere(const Imath::Vec2<T>& u) {
    const Imath::Vec2<T> d = square_to_disk(u);
    return {d.x, d.y, sqrt(max(T(0.0f), 1.0f - d.x * d.x - d.y * d.y))};
}
template <typename T = float>
[[nodiscard]] inline T cosine_hemisphere_pdf_solid_angle(const Imath::Vec3<T>& w) {
    return max(T(0.0f), w.z) * kInvPi;
}

/// Maps the unit square to the unit sphere, uniformly.
[[nodiscard]] inline Vec3f square_to_sphere(Vec2f u) {
    const float z = 1.0f - 2.0f * u.y;
    const float r = std::sqrt(std::max(0.0f, 1.0f - z * z));
    const SinCos phi = sin_cos_turns(u.x);
    return {r * phi.cos, r * phi.sin, z};
}
[[nodiscard]] inline float sphere_pdf_solid_angle() {
    return kInvPi / 4.0f;
}

/// Maps the unit square to the hemisphere around +z, uniformly.
[[nodiscard]] inline Vec3f square_to_hemisphere(Vec2f u) {
    const float z = 1.0f - u.y;
    const float r = std::sqrt(std::max(0.0f, 1.0f - z * z));
    const SinCos phi = sin_cos_turns(u.x);
    return {r * phi.cos, r * phi.sin, z};
}

[[nodiscard]] inline float hemisphere_pdf_solid_angle() {
    return kInvPi / 2.0f;
}

/// Maps the unit square uniformly to the cap of the unit sphere around +z that has this `height` > 0: one minus the
/// cosine of the cone's half angle. In single precision, the cosine itself cannot tell small angles apart.
[[nodiscard]] inline Vec3f square_to_spherical_cap(Vec2f u, float height) {
    const float one_minus_z = u.y * height;
    const float r = std::sqrt(std::max(0.0f, one_minus_z * (2.0f - one_minus_z)));
    const SinCos phi = sin_cos_turns(u.x);
    return {r * phi.cos, r * phi.sin, 1.0f - one_minus_z};
}
/// Maps the unit square to the cone of directions around +z whose half angle has the cosine `cos_max` (< 1), uniformly.
[[nodiscard]] inline Vec3f square_to_cone(Vec2f u, float cos_max) {
    return square_to_spherical_cap(u, 1.0f - cos_max);
}
[[nodiscard]] inline float cone_pdf_solid_angle(const Vec3f& w, float cos_max) {
    return w.z >= cos_max ? kInvPi * 0.5f / (1.0f - cos_max) : 0.0f;
}

/// Maps the unit square to a triangle, uniformly: to the barycentric coordinates of its second and third vertex.
/// Low-distortion map without a square root (Heitz, "A Low-Distortion Map Between Triangle and Square", 2019).
template <typename T = float>
[[nodiscard]] inline Imath::Vec2<T> square_to_triangle(const Imath::Vec2<T>& u) {
    // Half of the smaller number stays, and goes from the larger.
    const T half = 0.5f * min(u.x, u.y);
    const auto above = u.y > u.x;
    return {select(above, half, u.x - half), select(above, u.y - half, half)};
}
/// Returns the place in [0, 1)² that `square_to_triangle` takes to `b`.
[[nodiscard]] inline Vec2f triangle_to_square(Vec2f b) {
    return b.y > b.x ? Vec2f{2.0f * b.x, b.y + b.x} : Vec2f{b.x + b.y, 2.0f * b.y};
}

}  // namespace etendue
