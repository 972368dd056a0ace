// Where the nodes of the anisotropic albedo tables lie and how values between them are found: shared by the program
// that computes the tables and the code that reads them.
//
// A direction sees slopes of width `along` towards it and `across` beside it, correlated; `spread` is what is left of
// either once the other is known, alpha_x alpha_y / (along across): however narrow one alpha is, directions along and
// across grooves are as far apart as what they see. The albedo falls where cos theta comes near `along`; part of the
// cosine's coordinate follows that place, as in ggx_albedo_layout.h. The rest is for facets that tilt across and bend
// the curve elsewhere, interfaces of almost equal indices edge-on, and the critical index near normal incidence.
//
// Indices are placed as ggx_albedo_indices.h says. From inside, the albedo of grooves bends twice, as sharply as the
// narrower alpha is small, both times on a node: at the index from which on upright facets, as steep as there are,
// reflect totally, and where the last facets do, met at less than the critical angle by nothing that runs so closely
// along the grooves. Nearly level facets have one such place, the critical index itself. Tabulated is the root of what
// is missing to one: it is small on nearly smooth surfaces, and lobes divide by its average.
#pragma once

#include "bsdf/ggx.h"
#include "bsdf/ggx_albedo_indices.h"
#include "core/vec.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace etendue::ggx_anisotropic_layout {

using namespace ggx_albedo_indices;

inline constexpr int kCosines = 18;
inline constexpr int kAlongs = 28;
inline constexpr int kAcrosses = 20;
inline constexpr int kSpreads = 10;
inline constexpr int kEtasOutside = 23;  ///< from eta = 1 to 9
inline constexpr int kEtasInside = 42;   ///< from eta = 1 to 1/9
inline constexpr int kFirstBend = 14;    ///< nodes of the inside's
inline constexpr int kLastBend = 32;
inline constexpr int kAverageAlphas = 24;
inline constexpr int kAverageEtas = 44;  ///< for each side

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

/// Where in [low, 1] a coordinate that grows has the given value; either end, where that lies beyond. By bisection.
template <typename Coordinate>
[[nodiscard]] float at_coordinate(float value, float low, const Coordinate& coordinate) {
    float high = 1.0f;
    if (value <= coordinate(low)) return low;
    for (int i = 0; i < 40; ++i) {
        const float middle = 0.5f * (low + high);
        (coordinate(middle) < value ? low : high) = middle;
    }
    return high;
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

/// Nodes of a slope: even in x + `squared` x² + `cubed` x³, where x is the slope's fourth root. What wide grooves lose
/// varies most near 1 with the slope across; with the one along, edge-on, from a fiftieth to a third.
struct SlopeNodes {
    int count;
    float squared;
    float cubed;
};
inline constexpr SlopeNodes kAlongNodes{kAlongs, 1.5f, -0.85f};
inline constexpr SlopeNodes kAcrossNodes{kAcrosses, 1.5f, 0.0f};

[[nodiscard]] constexpr float slope_measure(float fourth_root, SlopeNodes nodes) {
    return fourth_root * (1.0f + fourth_root * (nodes.squared + fourth_root * nodes.cubed));
}
[[nodiscard]] inline float slope_coordinate(float slope_seen, SlopeNodes nodes) {
    constexpr float kRootOfSmallest = 0.177827941f;  // fourth root of kSmoothAlpha
    const float smallest = slope_measure(kRootOfSmallest, nodes);
    const float measure = slope_measure(std::sqrt(std::sqrt(slope_seen)), nodes);
    return (measure - smallest) * (static_cast<float>(nodes.count - 1) / (slope_measure(1.0f, nodes) - smallest));
}
/// `along` or `across` at a node.
[[nodiscard]] inline float slope(int node, SlopeNodes nodes) {
    return at_coordinate(static_cast<float>(node), kSmoothAlpha,
                         [nodes](float slope_seen) { return slope_coordinate(slope_seen, nodes); });
}

inline constexpr float kEvenSpread = 0.13f;  ///< the smaller, the closer are the nodes of `spread` near 0
[[nodiscard]] inline float spread(int node) {
    const float t = fraction(node, kSpreads);
    return t * (kEvenSpread + (1.0f - kEvenSpread) * t);
}
[[nodiscard]] inline float spread_coordinate(float spread) {
    constexpr float kSquared = kEvenSpread * kEvenSpread;
    return 2.0f * spread / (kEvenSpread + std::sqrt(kSquared + 4.0f * (1.0f - kEvenSpread) * spread)) * (kSpreads - 1);
}

// ---- Cosines

[[nodiscard]] inline float cosine_coordinate(float cos_theta, float along) {
    const float a = 4.0f * along;
    const float fall = std::sqrt(cos_theta * (1.0f + a) / (cos_theta + a));
    return (0.4f * fall +
            0.3f * (std::sqrt(std::sqrt(cos_theta)) + 1.0f - std::sqrt(std::max(0.0f, 1.0f - cos_theta)))) *
           (kCosines - 1);
}
/// Returns the cosine at a node: the inverse of `cosine_coordinate`.
[[nodiscard]] inline float cosine(int node, float along) {
    return at_coordinate(static_cast<float>(node), 0.0f,
                         [along](float cos_theta) { return cosine_coordinate(cos_theta, along); });
}

// ---- Indices, all of the denser side over the other

[[nodiscard]] inline float outside_eta(int node, float cos_theta, const Seen& slopes) {
    const float scale = index_scale(cos_theta, slopes.along);
    return eta_of(at_log_fraction(fraction(node, kEtasOutside), 0.0f, kLargestRoot, scale));
}
[[nodiscard]] inline float outside_coordinate(float eta, float cos_theta, const Seen& slopes) {
    const float scale = index_scale(cos_theta, slopes.along);
    return (kEtasOutside - 1) * log_fraction(r0_root(eta), 0.0f, kLargestRoot, scale);
}

// Up to either bend the steps shrink as a root does, and from the last one on they grow as a square does, and more.
inline constexpr float kEvenToFirst = 5.0f;
inline constexpr float kEvenToLast = 1.2f;
/// Maps [0, 1] onto itself: evenly for `even` 0, and the more like a root at 1 the larger `even` is.
[[nodiscard]] inline float shrink(float t, float even) {
    const float rest = 1.0f - t;
    return 1.0f - std::sqrt(std::max(0.0f, rest * (rest + even) / (1.0f + even)));
}
/// Maps [0, 1] onto itself as the inverse of `shrink`.
[[nodiscard]] inline float unshrink(float t, float even) {
    const float rest = 1.0f - t;
    return 1.0f - 0.5f * (std::sqrt(even * even + 4.0f * (1.0f + even) * rest * rest) - even);
}

/// Roots of the indices at which the albedo bends, seen from inside.
struct Bends {
    float first;
    float last;
    float even_to_last;  ///< the `even` of `shrink` between the two
};
/// Upright facets face along the wide alpha, and grooves run along the narrow one. The steps shrink towards the last
/// bend the less, the fewer facets are upright: nearly level ones bend nothing there.
[[nodiscard]] inline Bends bends(float cos_theta, const Seen& slopes) {
    constexpr float kWide4 = 0.12f * 0.12f;  // (alpha_x² + alpha_y²)² from which on upright facets count
    const float along2 = slopes.along * slopes.along;
    const float wide2 = along2 + slopes.across * slopes.across;
    const float upright = wide2 * wide2 / (wide2 * wide2 + kWide4);
    const float cos2 = cos_theta * cos_theta;
    const float sine2 = 1.0f - cos2;
    // Squared components of the direction along the wide alpha, were the other 0, and along the grooves.
    const float to_upright = sine2 * along2 / wide2;
    const float to_grooves = sine2 - to_upright;
    const float first = critical_root(1.0f - cos2 + (cos2 - to_upright) * upright);
    // It reaches the largest index at normal incidence rather than before, where it would stop at once. Edge-on it may
    // lie beyond that: if it stopped there, it would do so between nodes of the slopes.
    const float last = critical_root(to_grooves + kSmallestSine2 * cos2 * cos2, 0.5f * kSmallestSine2);
    return {std::min(first, last), last, kEvenToLast * upright};
}

[[nodiscard]] inline float inside_eta(int node, float cos_theta, const Seen& slopes) {
    const float scale = index_scale(cos_theta, slopes.along);
    const Bends at = bends(cos_theta, slopes);
    if (node < kFirstBend)
        return eta_of(at_log_fraction(unshrink(fraction(node, kFirstBend + 1), kEvenToFirst), 0.0f, at.first, scale));
    if (node < kLastBend) {
        const float t = fraction(node - kFirstBend, kLastBend - kFirstBend + 1);
        return eta_of(at_log_fraction(unshrink(t, at.even_to_last), at.first, at.last, scale));
    }
    const float t = fraction(node - kLastBend, kEtasInside - kLastBend);
    const float root = 2.0f * t / (3.0f - t);
    return eta_of(at_log_fraction(root * root, at.last, kLargestRoot, scale));
}

// ---- Interpolation

/// Between nodes `index` and `index + 1`, at `t` in [0, 1].
struct Linear {
    std::size_t index;
    float t;
};
/// The node at or before a coordinate that has another after it.
[[nodiscard]] inline int node_before(float coordinate, int count) {
    return std::clamp(static_cast<int>(coordinate), 0, count - 2);
}
/// Even in the coordinate.
[[nodiscard]] inline Linear slope_place(float slope_seen, SlopeNodes nodes) {
    const float coordinate = slope_coordinate(slope_seen, nodes);
    const int node = node_before(coordinate, nodes.count);
    return {static_cast<std::size_t>(node), std::clamp(coordinate - static_cast<float>(node), 0.0f, 1.0f)};
}
/// Even in the spread itself.
[[nodiscard]] inline Linear spread_place(float spread_seen) {
    const int node = node_before(spread_coordinate(spread_seen), kSpreads);
    const float low = spread(node);
    return {static_cast<std::size_t>(node), std::clamp((spread_seen - low) / (spread(node + 1) - low), 0.0f, 1.0f)};
}

/// Weights of four nodes from `first` on: the cubic through them.
struct Cubic {
    std::size_t first;
    std::array<float, 4> weights;
};
/// Returns the cubic at `coordinate` within the nodes from `low` to `high`.
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

/// Near normal incidence the nodes are even in the sine, of which what is missing is an even function, whatever the
/// slopes seen: the node beyond the last is the last but one.
[[nodiscard]] inline Cubic cosine_place(float coordinate) {
    const Cubic c = cubic(coordinate, 0, kCosines);
    if (c.first + 4 <= kCosines) return c;
    return {c.first - 1, {0.0f, c.weights[0], c.weights[1] + c.weights[3], c.weights[2]}};
}

/// Where a direction lies in a table, but for the index.
struct Position {
    Linear along, across, spread;
    Cubic cosine;
};
[[nodiscard]] inline Position position(const Seen& slopes, float cos_theta) {
    return {slope_place(slopes.along, kAlongNodes), slope_place(slopes.across, kAcrossNodes),
            spread_place(slopes.spread), cosine_place(cosine_coordinate(cos_theta, slopes.along))};
}

[[nodiscard]] inline Cubic outside_place(float eta, float cos_theta, const Seen& slopes) {
    return cubic(outside_coordinate(eta, cos_theta, slopes), 0, kEtasOutside - 1);
}
/// No cubic runs across a bend. `eta` >= 1.
[[nodiscard]] inline Cubic inside_place(float eta, float cos_theta, const Seen& slopes) {
    const float scale = index_scale(cos_theta, slopes.along);
    const Bends at = bends(cos_theta, slopes);
    const float root = r0_root(eta);
    if (root < at.first)
        return cubic(kFirstBend * shrink(log_fraction(root, 0.0f, at.first, scale), kEvenToFirst), 0, kFirstBend);
    if (root < at.last)
        return cubic(kFirstBend + (kLastBend - kFirstBend) *
                                      shrink(log_fraction(root, at.first, at.last, scale), at.even_to_last),
                     kFirstBend, kLastBend);
    const float beyond = std::sqrt(log_fraction(root, at.last, kLargestRoot, scale));
    return cubic(kLastBend + (kEtasInside - 1 - kLastBend) * (3.0f * beyond / (2.0f + beyond)), kLastBend,
                 kEtasInside - 1);
}

/// Returns the interpolated root, in [0, 1] up to overshoot. `weights` are those of the indices from node `first_eta`
/// on.
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
/// Returns what is missing, from its tabulated root: never all, though edge-on it comes so close that cubics overshoot.
[[nodiscard]] inline float missing_from_root(float root) {
    const float clamped = std::clamp(root, 0.0f, 0.9999f);
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
inline constexpr float kAverageScale = 0.0003f;
/// eta >= 1, for either side.
[[nodiscard]] inline float average_eta(int node) {
    return eta_of(at_log_fraction(fraction(node, kAverageEtas), 0.0f, kLargestRoot, kAverageScale));
}
[[nodiscard]] inline Cubic average_eta_place(float eta) {
    return cubic((kAverageEtas - 1) * log_fraction(r0_root(eta), 0.0f, kLargestRoot, kAverageScale), 0,
                 kAverageEtas - 1);
}
[[nodiscard]] inline float interpolate(const Averages& averages, const Cubic& x, const Cubic& y) {
    float sum = 0.0f;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) sum += x.weights[i] * y.weights[j] * averages[x.first + i][y.first + j];
    return sum;
}

// ---- The tables

/// Everything that the program computes, as it lies in its file and in memory.
struct Tables {
    Table<1> reflection;
    Table<1> schlick_share;
    Table<kEtasOutside> outside;
    Table<kEtasInside> inside;
    Averages reflection_average;
    Averages schlick_average;
    std::array<std::array<Averages, kAverageEtas>, 2> interface_average;  ///< [side][eta], side 0 outside (eta >= 1)
};

}  // namespace etendue::ggx_anisotropic_layout
