// Where the nodes of the anisotropic albedo tables lie: shared by the program that computes them and the code that
// reads them.
//
// x is the direction of the wider alpha. As in ggx_albedo_layout.h the cosine's coordinate follows the place where the
// albedo falls, which here depends on the alpha that the direction sees, sqrt(alpha_x² cos² phi + alpha_y² sin² phi).
// Schlick's albedo is stored as a share, with the coordinate sqrt(mu).
#pragma once

#include "bsdf/ggx_albedo_layout.h"
#include "core/vec.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace etendue::ggx_anisotropic_layout {

using ggx_albedo_layout::fraction;
using ggx_albedo_layout::kSmallestAlpha;
using ggx_albedo_layout::mix;
using ggx_albedo_layout::Place;
using ggx_albedo_layout::place;

inline constexpr int kCosines = 32;
inline constexpr int kAngles = 9;      ///< of phi in [0, pi / 2]
inline constexpr int kNarrows = 16;    ///< narrow alpha = t²
inline constexpr int kStrengths = 11;  ///< of wide alpha = mix(narrow, 1, s²)

using Row = std::array<float, kCosines>;
using Slice = std::array<std::array<Row, kAngles>, kStrengths>;
using Table = std::array<Slice, kNarrows>;
using Averages = std::array<std::array<float, kStrengths>, kNarrows>;

[[nodiscard]] inline float narrow_alpha(int node) {
    const float t = fraction(node, kNarrows);
    return std::max(kSmallestAlpha, t * t);
}
[[nodiscard]] inline float wide_alpha(float narrow, int node) {
    const float s = fraction(node, kStrengths);
    return mix(narrow, 1.0f, s * s);
}
[[nodiscard]] inline float strength_coordinate(float narrow, float wide) {
    const float range = 1.0f - narrow;
    return range > 0.0f ? std::sqrt(std::clamp((wide - narrow) / range, 0.0f, 1.0f)) * (kStrengths - 1) : 0.0f;
}

/// The alpha that a direction with azimuth (cos_phi, sin_phi) sees.
[[nodiscard]] inline float seen_alpha(float wide, float narrow, float cos_phi, float sin_phi) {
    const float x = wide * cos_phi;
    const float y = narrow * sin_phi;
    return std::sqrt(x * x + y * y);
}

[[nodiscard]] inline float cosine(int node, float alpha) {
    const float a = 4.0f * alpha;
    const float t = fraction(node, kCosines);
    return std::min(1.0f, t * t * a / (a + (1.0f - t) * (1.0f + t)));
}
[[nodiscard]] inline float share_cosine(int node) {
    const float t = fraction(node, kCosines);
    return t * t;
}
[[nodiscard]] inline float cosine_coordinate(float cos_theta, float alpha) {
    const float a = 4.0f * std::max(alpha, kSmallestAlpha);
    return std::sqrt(cos_theta * (1.0f + a) / (cos_theta + a)) * (kCosines - 1);
}

/// Everything that says where a direction lies in a table.
struct Position {
    Place narrow, strength, angle;
    Place cosine;        ///< in the table of albedos
    Place share_cosine;  ///< in the table of Schlick's shares
};

/// `x` and `y` of the direction along the wide and the narrow alpha, `cos_theta` in [0, 1].
[[nodiscard]] inline Position position(float wide, float narrow, float x, float y, float cos_theta) {
    const float sine = std::sqrt(x * x + y * y);
    const float cos_phi = sine > 0.0f ? std::min(1.0f, std::abs(x) / sine) : 1.0f;
    const float sin_phi = sine > 0.0f ? std::min(1.0f, std::abs(y) / sine) : 0.0f;
    const float angle = std::atan2(sin_phi, cos_phi) * (2.0f / kPi);
    return {place(std::sqrt(narrow) * (kNarrows - 1), kNarrows), place(strength_coordinate(narrow, wide), kStrengths),
            place(angle * (kAngles - 1), kAngles),
            place(cosine_coordinate(cos_theta, seen_alpha(wide, narrow, cos_phi, sin_phi)), kCosines),
            place(std::sqrt(cos_theta) * (kCosines - 1), kCosines)};
}

[[nodiscard]] inline float interpolate(const Row& row, Place c) {
    return mix(row[c.index], row[c.index + 1], c.t);
}
[[nodiscard]] inline float interpolate(const Slice& slice, const Position& p, Place c) {
    const auto at = [&](std::size_t s) {
        return mix(interpolate(slice[s][p.angle.index], c), interpolate(slice[s][p.angle.index + 1], c), p.angle.t);
    };
    return mix(at(p.strength.index), at(p.strength.index + 1), p.strength.t);
}
/// `c` is `p.cosine` or `p.share_cosine`, as the table wants it.
[[nodiscard]] inline float interpolate(const Table& table, const Position& p, Place c) {
    return mix(interpolate(table[p.narrow.index], p, c), interpolate(table[p.narrow.index + 1], p, c), p.narrow.t);
}
[[nodiscard]] inline float interpolate(const Averages& averages, Place narrow, Place strength) {
    const auto at = [&](std::size_t n) {
        return mix(averages[n][strength.index], averages[n][strength.index + 1], strength.t);
    };
    return mix(at(narrow.index), at(narrow.index + 1), narrow.t);
}

}  // namespace etendue::ggx_anisotropic_layout
