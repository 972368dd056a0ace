// Where the nodes of the albedo tables lie and how values between them are found: shared by the program that computes
// the tables and the code that reads them.
//
// The albedo falls where cos theta comes near alpha, so the cosine's coordinate is sqrt(mu (1 + a) / (mu + a)) with
// a about 4 alpha: the fall then has the same place for every alpha, and interpolating between two alphas does not blur
// it. Schlick's albedo is stored as a share of the former, which varies with mu alone and has the coordinate sqrt(mu).
// Indices are placed as ggx_albedo_indices.h says. Seen from inside, level facets begin to reflect totally at the
// critical index of the direction; it is on a node, so that interpolation between two alphas does not blur the bend.
#pragma once

#include "bsdf/ggx_albedo_indices.h"
#include "core/lane.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace etendue::ggx_albedo_layout {

using namespace ggx_albedo_indices;

inline constexpr int kCosines = 48;
inline constexpr int kAlphas = 38;       ///< alpha = t², t in [0, 1]: uniform in perceptual roughness
inline constexpr int kShareAlphas = 64;  ///< nodes of alpha for Schlick's share, which grazing angles bend more
/// Is the number of nodes of alpha for the averages, which are not piecewise linear in t, but have kinks at the nodes
/// of the albedos.
inline constexpr int kAverageAlphas = 10 * (kAlphas - 1) + 1;
inline constexpr int kEtasOutside = 30;   ///< from eta = 1 to 9
inline constexpr int kEtasInside = 48;    ///< from eta = 1 to 1/9
inline constexpr int kCriticalNode = 18;  ///< node of the critical index among those inside
inline constexpr int kAverageEtas = 64;   ///< for each side

using Slice = std::array<std::array<float, kCosines>, kAlphas>;  ///< [alpha][cosine]
using ShareSlice = std::array<std::array<float, kCosines>, kShareAlphas>;
using Averages = std::array<float, kAverageAlphas>;

inline constexpr float kSmallestAlpha = 1e-4f;
inline constexpr float kAverageScale = 0.003f;  ///< scale of the averages' indices

/// Position of `node` out of `count` in [0, 1].
[[nodiscard]] inline float fraction(int node, int count) {
    return static_cast<float>(node) / static_cast<float>(count - 1);
}

[[nodiscard]] inline float alpha(int node, int count) {
    const float t = fraction(node, count);
    return std::max(kSmallestAlpha, t * t);
}
template <typename T>
[[nodiscard]] inline T alpha_coordinate(T a, int count) {
    return sqrt(a) * static_cast<float>(count - 1);
}

/// Where the albedo falls, and a little above for alphas near 0: nodes are left for what nearly smooth surfaces lose
/// near the critical angle.
template <typename T>
[[nodiscard]] inline T fall(T alpha_of_row) {
    return 4.0f * alpha_of_row + 0.006f;
}
/// `coordinate` in [0, kCosines - 1].
[[nodiscard]] inline float cosine(float coordinate, float alpha_of_row) {
    const float a = fall(alpha_of_row);
    const float t = coordinate / (kCosines - 1);
    return std::min(1.0f, t * t * a / (a + (1.0f - t) * (1.0f + t)));
}
template <typename T>
[[nodiscard]] inline T cosine_coordinate(T cos_theta, T alpha_of_row) {
    const T a = fall(alpha_of_row);
    return sqrt(cos_theta * (1.0f + a) / (cos_theta + a)) * static_cast<float>(kCosines - 1);
}

[[nodiscard]] inline float share_cosine(int node) {
    const float t = fraction(node, kCosines);
    return t * t;
}
template <typename T>
[[nodiscard]] inline T share_cosine_coordinate(T cos_theta) {
    return sqrt(cos_theta) * static_cast<float>(kCosines - 1);
}

// ---- Indices, all of the denser side over the other

[[nodiscard]] inline float outside_eta(int node, float cos_theta, float alpha_of_row) {
    const float scale = index_scale(cos_theta, alpha_of_row);
    return eta_of(at_log_fraction(fraction(node, kEtasOutside), 0.0f, kLargestRoot, scale));
}
[[nodiscard]] inline float outside_coordinate(float eta, float cos_theta, float alpha) {
    const float scale = index_scale(cos_theta, alpha);
    return (kEtasOutside - 1) * log_fraction(r0_root(eta), 0.0f, kLargestRoot, scale);
}

/// Root of the critical index. Towards normal incidence it would run to infinity: it is held back there, where facets
/// that are level enough to share it lose nothing.
[[nodiscard]] inline float level_root(float cos_theta) {
    const float cos2 = cos_theta * cos_theta;
    return critical_root(1.0f - cos2 + 0.15f * cos2 * cos2);
}
[[nodiscard]] inline float inside_eta(int node, float cos_theta, float alpha_of_row) {
    const float scale = index_scale(cos_theta, alpha_of_row);
    const float level = level_root(cos_theta);
    return eta_of(node < kCriticalNode ? at_log_fraction(fraction(node, kCriticalNode + 1), 0.0f, level, scale)
                                       : at_log_fraction(fraction(node - kCriticalNode, kEtasInside - kCriticalNode),
                                                         level, kLargestRoot, scale));
}
[[nodiscard]] inline float inside_coordinate(float eta, float cos_theta, float alpha) {
    const float scale = index_scale(cos_theta, alpha);
    const float level = level_root(cos_theta);
    const float root = r0_root(eta);
    if (root < level) return kCriticalNode * log_fraction(root, 0.0f, level, scale);
    return kCriticalNode + (kEtasInside - 1 - kCriticalNode) * log_fraction(root, level, kLargestRoot, scale);
}

/// Returns the index of a node of the averages, for either side.
[[nodiscard]] inline float average_eta(int node) {
    return eta_of(at_log_fraction(fraction(node, kAverageEtas), 0.0f, kLargestRoot, kAverageScale));
}
[[nodiscard]] inline float average_eta_coordinate(float eta) {
    return (kAverageEtas - 1) * log_fraction(r0_root(eta), 0.0f, kLargestRoot, kAverageScale);
}

// ---- Interpolation

/// Between nodes `index`, a whole number, and `index + 1`, at `t` in [0, 1].
template <typename T>
struct Place {
    T index;
    T t;
};

template <typename T>
[[nodiscard]] inline Place<T> place(T coordinate, int count) {
    // What is no number is at the first: lanes that nobody asks for are looked up too.
    const T clamped = min(max(T(0.0f), coordinate), T(static_cast<float>(count - 1)));
    const T index = min(floor(clamped), T(static_cast<float>(count - 2)));
    return {index, clamped - index};
}

template <typename T>
[[nodiscard]] inline T mix(T a, T b, T t) {
    return a + (b - a) * t;
}

template <typename T, std::size_t Rows, std::size_t Columns>
[[nodiscard]] T interpolate(const std::array<std::array<float, Columns>, Rows>& table, const Place<T>& row,
                            const Place<T>& column) {
    // One block of memory, row after row.
    const float* low = table.front().data();
    const float* high = low + Columns;
    const T first = row.index * static_cast<float>(Columns) + column.index;
    return mix(mix(gather(low, first), gather(low + 1, first), column.t),
               mix(gather(high, first), gather(high + 1, first), column.t), row.t);
}
template <std::size_t Etas>
[[nodiscard]] float interpolate(const std::array<Slice, Etas>& slices, const Place<float>& e, const Place<float>& a,
                                const Place<float>& c) {
    const auto low = static_cast<std::size_t>(e.index);
    return mix(interpolate(slices[low], a, c), interpolate(slices[low + 1], a, c), e.t);
}
template <typename T>
[[nodiscard]] T interpolate(const Averages& averages, const Place<T>& a) {
    return mix(gather(averages.data(), a.index), gather(averages.data() + 1, a.index), a.t);
}

/// Everything that the program computes, as it lies in its file and in memory.
struct Tables {
    Slice single;
    ShareSlice schlick_share;
    std::array<Slice, kEtasOutside> outside;
    std::array<Slice, kEtasInside> inside;
    Averages single_average;
    Averages schlick_average;
    std::array<std::array<Averages, kAverageEtas>, 2> dielectric_average;  ///< [side][eta], side 0 outside (eta >= 1)
    // These tables are of an interface whose facets reflect only where reflection is total.
    std::array<Slice, kEtasOutside> total_only_outside;
    std::array<Slice, kEtasInside> total_only_inside;
    std::array<std::array<Averages, kAverageEtas>, 2> total_only_average;
};

}  // namespace etendue::ggx_albedo_layout
