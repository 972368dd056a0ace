// What the tests of warps (sampling/warp.h) ask of them besides: inverses, and densities that nothing else needs.
#pragma once

#include "sampling/warp.h"

namespace etendue::test {

/// Returns the density of square_to_disk.
[[nodiscard]] inline float disk_pdf_area(Vec2f p) {
    return p.x * p.x + p.y * p.y <= 1.0f ? kInvPi : 0.0f;
}

/// Returns the numbers that square_to_disk maps to `p`.
[[nodiscard]] inline Vec2f disk_to_square(Vec2f p) {
    const float r = std::sqrt(p.x * p.x + p.y * p.y);
    float phi = std::atan2(p.y, p.x);
    if (phi < -kPi / 4.0f) phi += 2.0f * kPi;
    float a = 0.0f;
    float b = 0.0f;
    if (phi < kPi / 4.0f) {
        a = r;
        b = phi * a / (kPi / 4.0f);
    } else if (phi < 3.0f * kPi / 4.0f) {
        b = r;
        a = -(phi - kPi / 2.0f) * b / (kPi / 4.0f);
    } else if (phi < 5.0f * kPi / 4.0f) {
        a = -r;
        b = (phi - kPi) * a / (kPi / 4.0f);
    } else {
        b = -r;
        a = -(phi - 3.0f * kPi / 2.0f) * b / (kPi / 4.0f);
    }
    return {(a + 1.0f) * 0.5f, (b + 1.0f) * 0.5f};
}

/// Returns the density of square_to_regular_polygon.
[[nodiscard]] inline float regular_polygon_pdf_area(Vec2f p, int corners) {
    const float half_angle = kPi / static_cast<float>(corners);
    const float side = std::round(std::atan2(p.y, p.x) / (2.0f * half_angle)) * 2.0f * half_angle;
    if (std::cos(side) * p.x + std::sin(side) * p.y > std::cos(half_angle)) return 0.0f;
    return 1.0f / (static_cast<float>(corners) * std::cos(half_angle) * std::sin(half_angle));
}

/// Returns the numbers that square_to_regular_polygon maps to `p`.
[[nodiscard]] inline Vec2f regular_polygon_to_square(Vec2f p, int corners) {
    const auto count = static_cast<float>(corners);
    const float half_angle = kPi / count;
    const float which = std::round(std::atan2(p.y, p.x) / (2.0f * half_angle));
    const float turn = 2.0f * half_angle * which;
    const float x = std::cos(turn) * p.x + std::sin(turn) * p.y;
    const float y = std::cos(turn) * p.y - std::sin(turn) * p.x;
    const float from_middle = x / std::cos(half_angle);
    const float along_side = from_middle > 0.0f ? y / (from_middle * std::sin(half_angle)) : 0.0f;
    return {((which < 0.0f ? which + count : which) + from_middle * from_middle) / count, 0.5f * (along_side + 1.0f)};
}

/// Returns the numbers that square_to_cosine_hemisphere maps to `w`.
[[nodiscard]] inline Vec2f cosine_hemisphere_to_square(const Vec3f& w) {
    return disk_to_square({w.x, w.y});
}

/// Returns the numbers that square_to_sphere maps to `w`.
[[nodiscard]] inline Vec2f sphere_to_square(const Vec3f& w) {
    const float phi = std::atan2(w.y, w.x) * (kInvPi * 0.5f);
    return {phi < 0.0f ? phi + 1.0f : phi, (1.0f - w.z) * 0.5f};
}

/// Returns the density of square_to_hemisphere.
[[nodiscard]] inline float hemisphere_pdf_solid_angle(const Vec3f& w) {
    return w.z >= 0.0f ? kInvPi * 0.5f : 0.0f;
}

/// Returns the numbers that square_to_hemisphere maps to `w`.
[[nodiscard]] inline Vec2f hemisphere_to_square(const Vec3f& w) {
    return {sphere_to_square(w).x, 1.0f - w.z};
}

/// Returns the numbers that square_to_cone maps to `w`.
[[nodiscard]] inline Vec2f cone_to_square(const Vec3f& w, float cos_max) {
    return {sphere_to_square(w).x, (1.0f - w.z) / (1.0f - cos_max)};
}

}  // namespace etendue::test
