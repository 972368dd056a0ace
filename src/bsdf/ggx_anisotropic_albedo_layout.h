// Where the nodes of the anisotropic albedo tables lie and how values between them are found: shared by the program
// that computes the tables and the code that reads them.
//
// A direction sees slopes of width `along` towards it and `across` beside it, correlated; `spread` is what is left of
// either once the other is known, alpha_x alpha_y / (along across). Seen so, directions along and across grooves are as
// far apart as what they see, however narrow one alpha is. The albedo falls where cos theta comes near `along`, and
// part of the cosine's coordinate follows that place, as in ggx_albedo_layout.h. Facets that tilt across bend the curve
// elsewhere, interfaces of almost equal indices edge-on, and the critical index varies near normal incidence: the rest
// of the coordinate is for those.
//
// From inside, grooves reflect totally what runs along them at more than the critical angle, whatever their facets'
// slopes: the albedo has a kink there, as sharp as the narrower alpha. The index's coordinate puts it on a node.
//
// Tabulated is the root of what is missing to one: it is small on nearly smooth surfaces, and lobes divide by its
// average.
#pragma once

#include "bsdf/ggx.h"
#include "bsdf/ggx_albedo.h"
#include "core/vec.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace etendue::ggx_anisotropic_layout {

inline constexpr int kCosines = 24;
inline constexpr int kAlongs = 20;
inline constexpr int kAcrosses = 18;
inline constexpr int kSpreads = 7;
inline constexpr int kEtasOutside = 16;  ///< from 1 to 9
inline constexpr int kKinkNode = 21;     ///< of the inside's indices: the critical one
inline constexpr int kEtasInside = 27;   ///< indices above it are taken for 1 / eta
inline constexpr int kAverageAlphas = 18;
inline constexpr int kAverageEtas = 20;  ///< for each side

template <std::size_t Etas>
using Block = std::array<std::array<std::uint16_t, kCosines>, Etas>;
template <std::size_t Etas>
using Table = std::array<Block<Etas>, std::size_t{kAlongs} * kAcrosses * kSpreads>;
[[nodiscard]] constexpr std::size_t block_index(std::size_t along, std::size_t across, std::size_t spread) {
    return (along * kAcrosses + across) * kSpreads + spread;
}
inline constexpr float kLargestValue = 65535.0f;  ///< stands for 1

/// Logarithms of what is missing on average, or plain averages: [alpha_x][alpha_y].
using Averages = std::array<std::array<float, kAverageAlphas>, kAverageAlphas>;

[[nodiscard]] inline float fraction(int node, int count) {
    return static_cast<float>(node) / static_cast<float>(count - 1);
}

// ---- Slopes

struct Seen {
    float along;
    float across;
    float spread;  ///< [0, 1]
};
[[nodiscard]] inline Seen seen(const Vec3f& w, float alpha_x, float alpha_y) {
    const float sine2 = w.x * w.x + w.y * w.y;
    const float x2 = sine2 > 0.0f ? w.x * w.x / sine2 : 1.0f;
    const float y2 = sine2 > 0.0f ? w.y * w.y / sine2 : 0.0f;
    const float ax2 = alpha_x * alpha_x;
    const float ay2 = alpha_y * alpha_y;
    const float along = std::sqrt(ax2 * x2 + ay2 * y2);
    const float across = std::sqrt(ax2 * y2 + ay2 * x2);
    return {along, across, std::min(1.0f, alpha_x * alpha_y / (along * across))};
}

inline constexpr float kRootOfSmallest = 0.177827941f;  ///< fourth root of kSmoothAlpha
/// `along` or `across` at a node. What narrow grooves lose from their own direction varies most near 0.
[[nodiscard]] inline float slope(int node, int count) {
    const float root = kRootOfSmallest + (1.0f - kRootOfSmallest) * fraction(node, count);
    return root * root * root * root;
}
[[nodiscard]] inline float spread(int node) {
    const float t = fraction(node, kSpreads);
    return t * t;
}
[[nodiscard]] inline float spread_coordinate(float spread) {
    return std::sqrt(spread) * (kSpreads - 1);
}

// ---- Cosines

[[nodiscard]] inline float cosine_coordinate(float cos_theta, float along) {
    const float a = 4.0f * along;
    const float fall = std::sqrt(cos_theta * (1.0f + a) / (cos_theta + a));
    return (0.4f * fall +
            0.3f * (std::sqrt(std::sqrt(cos_theta)) + 1.0f - std::sqrt(std::max(0.0f, 1.0f - cos_theta)))) *
           (kCosines - 1);
}
/// Its inverse at a node, by bisection.
[[nodiscard]] inline float cosine(int node, float along) {
    if (node == 0) return 0.0f;
    float low = 0.0f;
    float high = 1.0f;
    for (int i = 0; i < 40; ++i) {
        const float middle = 0.5f * (low + high);
        (cosine_coordinate(middle, along) < static_cast<float>(node) ? low : high) = middle;
    }
    return high;
}

// ---- Indices

/// Even in the logarithm of (eta - 1) / (eta + 1) + `scale`, from 0 at eta = 1 to 1 at kMaxTabulatedEta.
inline constexpr float kLargestR0Root = (kMaxTabulatedEta - 1.0f) / (kMaxTabulatedEta + 1.0f);
inline constexpr float kScaleOutside = 0.005f;
inline constexpr float kScaleInside = 0.006f;
[[nodiscard]] inline float eta_fraction(float eta, float scale) {
    return std::log(1.0f + (eta - 1.0f) / ((eta + 1.0f) * scale)) / std::log(1.0f + kLargestR0Root / scale);
}
[[nodiscard]] inline float eta_at(float fraction, float scale) {
    const float root = scale * std::expm1(fraction * std::log(1.0f + kLargestR0Root / scale));
    return (1.0f + root) / (1.0f - root);
}

/// The index from which on the grooves reflect totally, at most kMaxTabulatedEta. Where even the wider alpha is small
/// there are no grooves to speak of, and facets are level.
[[nodiscard]] inline float critical_eta(float cos_theta, const Seen& slopes) {
    constexpr float kWide2 = 0.0002f;  // squared alpha from which on grooves count
    const float along2 = slopes.along * slopes.along;
    const float across2 = slopes.across * slopes.across;
    const float both4 = (along2 + across2) * (along2 + across2);
    const float grooves = both4 / (both4 + kWide2 * kWide2);
    const float beside = across2 + kWide2 * (1.0f - grooves);
    const float sine2 = (1.0f - cos_theta * cos_theta) * beside / (beside + along2 * grooves);
    const float cos2 = cos_theta * cos_theta;
    // Towards normal incidence it would change from node to node, without being sharp.
    const float limited = sine2 + 0.04f * cos2 * cos2;
    return limited * (kMaxTabulatedEta * kMaxTabulatedEta) > 1.0f ? 1.0f / std::sqrt(limited) : kMaxTabulatedEta;
}

// Below the critical index e the coordinate's steps shrink towards it as a root does, and far from it they are even.
inline constexpr float kEven = 0.5f;
/// `eta` and `critical` >= 1.
[[nodiscard]] inline float inside_coordinate(float eta, float critical) {
    const float z = eta_fraction(eta, kScaleInside);
    const float kink = eta_fraction(critical, kScaleInside);
    if (z < kink) {
        const float below = 1.0f - z / kink;
        return kKinkNode * (1.0f - std::sqrt(below * (below + kEven) / (1.0f + kEven)));
    }
    const float above = kink < 1.0f ? std::sqrt((z - kink) / (1.0f - kink)) : 0.0f;
    return kKinkNode + (kEtasInside - 1 - kKinkNode) * above;
}
/// eta >= 1 at a node.
[[nodiscard]] inline float inside_eta(int node, float critical) {
    const float kink = eta_fraction(critical, kScaleInside);
    if (node < kKinkNode) {
        const float u = 1.0f - static_cast<float>(node) / kKinkNode;
        const float below = 0.5f * (std::sqrt(kEven * kEven + 4.0f * (1.0f + kEven) * u * u) - kEven);
        return eta_at(kink * (1.0f - below), kScaleInside);
    }
    const float above = static_cast<float>(node - kKinkNode) / (kEtasInside - 1 - kKinkNode);
    return eta_at(kink + (1.0f - kink) * above * above, kScaleInside);
}

// ---- Interpolation

/// Between nodes `index` and `index + 1`, at `t` in [0, 1].
struct Linear {
    std::size_t index;
    float t;
};
[[nodiscard]] inline Linear linear(float coordinate, int count) {
    const float clamped = std::clamp(coordinate, 0.0f, static_cast<float>(count - 1));
    const int index = std::min(static_cast<int>(clamped), count - 2);
    return {static_cast<std::size_t>(index), clamped - static_cast<float>(index)};
}

/// Even in the slope between two nodes.
[[nodiscard]] inline Linear slope_place(float slope_seen, int count) {
    const float coordinate = (std::sqrt(std::sqrt(slope_seen)) - kRootOfSmallest) *
                             (static_cast<float>(count - 1) / (1.0f - kRootOfSmallest));
    const int index = std::clamp(static_cast<int>(coordinate), 0, count - 2);
    const float low = slope(index, count);
    const float t = (slope_seen - low) / (slope(index + 1, count) - low);
    return {static_cast<std::size_t>(index), std::clamp(t, 0.0f, 1.0f)};
}

/// Weights of four nodes from `first` on: the cubic through them.
struct Cubic {
    std::size_t first;
    std::array<float, 4> weights;
};
/// Within the nodes from `low` to `high`.
[[nodiscard]] inline Cubic cubic(float coordinate, int low, int high) {
    const float clamped = std::clamp(coordinate, static_cast<float>(low), static_cast<float>(high));
    const int first = std::clamp(static_cast<int>(clamped) - 1, low, high - 3);
    const float x = clamped - static_cast<float>(first);
    const float x1 = x - 1.0f;
    const float x2 = x - 2.0f;
    const float x3 = x - 3.0f;
    return {static_cast<std::size_t>(first),
            {x1 * x2 * x3 * (-1.0f / 6.0f), x * x2 * x3 * 0.5f, x * x1 * x3 * -0.5f, x * x1 * x2 * (1.0f / 6.0f)}};
}

/// Where a direction lies in a table, but for the index.
struct Position {
    Linear along, across, spread;
    Cubic cosine;
};
[[nodiscard]] inline Position position(const Seen& slopes, float cos_theta) {
    return {slope_place(slopes.along, kAlongs), slope_place(slopes.across, kAcrosses),
            linear(spread_coordinate(slopes.spread), kSpreads),
            cubic(cosine_coordinate(cos_theta, slopes.along), 0, kCosines - 1)};
}

[[nodiscard]] inline Cubic outside_place(float eta) {
    return cubic(eta_fraction(eta, kScaleOutside) * (kEtasOutside - 1), 0, kEtasOutside - 1);
}
/// The kink is on a node, and no cubic runs across it.
[[nodiscard]] inline Cubic inside_place(float eta, float critical) {
    const float coordinate = inside_coordinate(eta, critical);
    return coordinate < kKinkNode ? cubic(coordinate, 0, kKinkNode) : cubic(coordinate, kKinkNode, kEtasInside - 1);
}

/// In [0, 1] up to overshoot. `weights` are those of the indices from node `first_eta` on.
template <std::size_t Etas, std::size_t Rows>
[[nodiscard]] float interpolate(const Table<Etas>& table, const Position& p, std::size_t first_eta,
                                const std::array<float, Rows>& weights) {
    std::array<float, 4> sums{};
    for (std::size_t corner = 0; corner < 8; ++corner) {
        const std::size_t a = corner & 1u;
        const std::size_t c = (corner >> 1u) & 1u;
        const std::size_t s = corner >> 2u;
        const float weight = (a != 0 ? p.along.t : 1.0f - p.along.t) * (c != 0 ? p.across.t : 1.0f - p.across.t) *
                             (s != 0 ? p.spread.t : 1.0f - p.spread.t);
        const Block<Etas>& block = table[block_index(p.along.index + a, p.across.index + c, p.spread.index + s)];
        for (std::size_t e = 0; e < Rows; ++e) {
            const std::uint16_t* values = block[first_eta + e].data() + p.cosine.first;
            for (std::size_t k = 0; k < 4; ++k) sums[k] += weight * weights[e] * static_cast<float>(values[k]);
        }
    }
    float sum = 0.0f;
    for (std::size_t k = 0; k < 4; ++k) sum += sums[k] * p.cosine.weights[k];
    return sum * (1.0f / kLargestValue);
}
[[nodiscard]] inline float interpolate(const Table<1>& table, const Position& p) {
    return interpolate(table, p, 0, std::array{1.0f});
}
/// What is missing, from its tabulated root.
[[nodiscard]] inline float missing_from_root(float root) {
    const float clamped = std::clamp(root, 0.0f, 1.0f);
    return clamped * clamped;
}
template <std::size_t Etas>
[[nodiscard]] float missing(const Table<Etas>& table, const Position& p, const Cubic& eta) {
    return missing_from_root(interpolate(table, p, eta.first, eta.weights));
}

// ---- Averages

/// Even in the logarithm.
[[nodiscard]] inline float average_alpha(int node) {
    return std::pow(kSmoothAlpha, 1.0f - fraction(node, kAverageAlphas));
}
[[nodiscard]] inline Cubic average_place(float alpha) {
    const float coordinate = (1.0f - std::log(alpha) / std::log(kSmoothAlpha)) * (kAverageAlphas - 1);
    return cubic(coordinate, 0, kAverageAlphas - 1);
}
/// eta >= 1, for either side.
[[nodiscard]] inline float average_eta(int node) {
    return eta_at(fraction(node, kAverageEtas), kScaleInside);
}
[[nodiscard]] inline Cubic average_eta_place(float eta) {
    return cubic(eta_fraction(eta, kScaleInside) * (kAverageEtas - 1), 0, kAverageEtas - 1);
}
[[nodiscard]] inline float interpolate(const Averages& averages, const Cubic& x, const Cubic& y) {
    float sum = 0.0f;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) sum += x.weights[i] * y.weights[j] * averages[x.first + i][y.first + j];
    return sum;
}

}  // namespace etendue::ggx_anisotropic_layout
