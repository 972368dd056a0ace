// Where the nodes of the anisotropic albedo tables lie: shared by the program that computes them and the code that
// reads them.
//
// x is the direction of the wider alpha. As in ggx_albedo_layout.h the cosine's coordinate follows the place where the
// albedo falls, which here depends on the alpha that the direction sees, sqrt(alpha_x² cos² phi + alpha_y² sin² phi);
// facets that tilt across the direction blur that place, so a part of the wider alpha is added everywhere.
// Schlick's albedo is stored as a share, with the coordinate sqrt(mu).
#pragma once

#include "bsdf/ggx_albedo_layout.h"
#include "core/vec.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace etendue::ggx_anisotropic_layout {

using ggx_albedo_layout::eta;
using ggx_albedo_layout::eta_coordinate;
using ggx_albedo_layout::fraction;
using ggx_albedo_layout::kSmallestAlpha;
using ggx_albedo_layout::mix;
using ggx_albedo_layout::Place;
using ggx_albedo_layout::place;

/// Nodes of a table.
struct Sizes {
    int cosines;
    int angles;     ///< of phi in [0, pi / 2]
    int narrows;    ///< narrow alpha = t²
    int strengths;  ///< of wide alpha = mix(narrow, 1, s²)
    int across;     ///< percent of the wider alpha's square that is added across it
};
inline constexpr Sizes kReflection{32, 9, 16, 11, 0};
inline constexpr Sizes kDielectric{20, 7, 11, 8, 3};
inline constexpr int kEtas = 11;  ///< of the dielectric tables, from eta = 1 on, for each side

template <Sizes S>
using Row = std::array<float, S.cosines>;
template <Sizes S>
using Slice = std::array<std::array<Row<S>, S.angles>, S.strengths>;
template <Sizes S>
using Table = std::array<Slice<S>, S.narrows>;
template <Sizes S>
using Averages = std::array<std::array<float, S.strengths>, S.narrows>;

template <Sizes S>
[[nodiscard]] float narrow_alpha(int node) {
    const float t = fraction(node, S.narrows);
    return std::max(kSmallestAlpha, t * t);
}
template <Sizes S>
[[nodiscard]] float wide_alpha(float narrow, int node) {
    const float s = fraction(node, S.strengths);
    return mix(narrow, 1.0f, s * s);
}
template <Sizes S>
[[nodiscard]] float strength_coordinate(float narrow, float wide) {
    const float range = 1.0f - narrow;
    return range > 0.0f ? std::sqrt(std::clamp((wide - narrow) / range, 0.0f, 1.0f)) * (S.strengths - 1) : 0.0f;
}

/// The alpha that a direction with azimuth (cos_phi, sin_phi) sees, blurred by what tilts across it.
template <Sizes S>
[[nodiscard]] float seen_alpha(float wide, float narrow, float cos_phi, float sin_phi) {
    constexpr float kAcross = 0.01f * S.across;
    const float x2 = wide * wide * (cos_phi * cos_phi + kAcross * sin_phi * sin_phi);
    const float y = narrow * sin_phi;
    return std::min(1.0f, std::sqrt(x2 + y * y));
}

template <Sizes S>
[[nodiscard]] float cosine(int node, float alpha) {
    const float a = 4.0f * alpha;
    const float t = fraction(node, S.cosines);
    return std::min(1.0f, t * t * a / (a + (1.0f - t) * (1.0f + t)));
}
template <Sizes S>
[[nodiscard]] float share_cosine(int node) {
    const float t = fraction(node, S.cosines);
    return t * t;
}
template <Sizes S>
[[nodiscard]] float cosine_coordinate(float cos_theta, float alpha) {
    const float a = 4.0f * std::max(alpha, kSmallestAlpha);
    return std::sqrt(cos_theta * (1.0f + a) / (cos_theta + a)) * (S.cosines - 1);
}

/// Everything that says where a direction lies in a table.
struct Position {
    Place narrow, strength, angle;
    Place cosine;        ///< in the table of albedos
    Place share_cosine;  ///< in the table of Schlick's shares
};

/// `x` and `y` of the direction along the wide and the narrow alpha, `cos_theta` in [0, 1].
template <Sizes S>
[[nodiscard]] Position position(float wide, float narrow, float x, float y, float cos_theta) {
    const float sine = std::sqrt(x * x + y * y);
    const float cos_phi = sine > 0.0f ? std::min(1.0f, std::abs(x) / sine) : 1.0f;
    const float sin_phi = sine > 0.0f ? std::min(1.0f, std::abs(y) / sine) : 0.0f;
    const float angle = std::atan2(sin_phi, cos_phi) * (2.0f / kPi);
    return {place(std::sqrt(narrow) * (S.narrows - 1), S.narrows),
            place(strength_coordinate<S>(narrow, wide), S.strengths), place(angle * (S.angles - 1), S.angles),
            place(cosine_coordinate<S>(cos_theta, seen_alpha<S>(wide, narrow, cos_phi, sin_phi)), S.cosines),
            place(std::sqrt(cos_theta) * (S.cosines - 1), S.cosines)};
}

template <std::size_t Cosines>
[[nodiscard]] float interpolate(const std::array<float, Cosines>& row, Place c) {
    return mix(row[c.index], row[c.index + 1], c.t);
}
/// `c` is `p.cosine` or `p.share_cosine`, as the table wants it.
template <Sizes S>
[[nodiscard]] float interpolate(const Table<S>& table, const Position& p, Place c) {
    const auto at = [&](std::size_t n, std::size_t s) {
        const auto& angles = table[n][s];
        return mix(interpolate(angles[p.angle.index], c), interpolate(angles[p.angle.index + 1], c), p.angle.t);
    };
    const auto along = [&](std::size_t n) {
        return mix(at(n, p.strength.index), at(n, p.strength.index + 1), p.strength.t);
    };
    return mix(along(p.narrow.index), along(p.narrow.index + 1), p.narrow.t);
}
template <Sizes S>
[[nodiscard]] float interpolate(const Averages<S>& averages, Place narrow, Place strength) {
    const auto at = [&](std::size_t n) {
        return mix(averages[n][strength.index], averages[n][strength.index + 1], strength.t);
    };
    return mix(at(narrow.index), at(narrow.index + 1), narrow.t);
}

}  // namespace etendue::ggx_anisotropic_layout
