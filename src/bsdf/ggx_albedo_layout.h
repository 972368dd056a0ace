// Where the nodes of the albedo tables lie and how values between them are found: shared by the program that computes
// the tables and the code that reads them.
//
// The albedo falls where cos theta comes near alpha, so the cosine's coordinate is sqrt(mu (1 + a) / (mu + a)) with
// a = 4 alpha: the fall then has the same place for every alpha, and interpolating between two alphas does not blur it.
// Schlick's albedo is stored as a share of the former, which varies with mu alone and has the coordinate sqrt(mu).
// Indices have the coordinate cbrt((eta - 1) / (eta + 1)). The cosine of the critical angle moves as the square root of
// that fraction; the cube root sets the nodes closer where the angle is grazing, as there it is where the albedo falls.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace etendue::ggx_albedo_layout {

inline constexpr int kCosines = 48;
inline constexpr int kAlphas = 40;       ///< alpha = t², t in [0, 1]: uniform in perceptual roughness
inline constexpr int kShareAlphas = 64;  ///< the same for Schlick's share, which grazing angles bend more
/// The same for the averages. They are not piecewise linear in t, but have kinks at the nodes of the albedos.
inline constexpr int kAverageAlphas = 10 * (kAlphas - 1) + 1;
inline constexpr int kEtas = 42;  ///< from eta = 1 to 9, for each side

using Slice = std::array<std::array<float, kCosines>, kAlphas>;  ///< [alpha][cosine]
using ShareSlice = std::array<std::array<float, kCosines>, kShareAlphas>;
using Averages = std::array<float, kAverageAlphas>;

inline constexpr float kSmallestAlpha = 1e-4f;
inline constexpr float kLargestR0Root = 0.8f;  ///< (9 - 1) / (9 + 1)

/// Position of `node` out of `count` in [0, 1].
[[nodiscard]] inline float fraction(int node, int count) {
    return static_cast<float>(node) / static_cast<float>(count - 1);
}

[[nodiscard]] inline float alpha(int node, int count) {
    const float t = fraction(node, count);
    return std::max(kSmallestAlpha, t * t);
}
[[nodiscard]] inline float alpha_coordinate(float a, int count) {
    return std::sqrt(a) * static_cast<float>(count - 1);
}

/// `coordinate` in [0, kCosines - 1].
[[nodiscard]] inline float cosine(float coordinate, float alpha_of_row) {
    const float a = 4.0f * alpha_of_row;
    const float t = coordinate / (kCosines - 1);
    return std::min(1.0f, t * t * a / (a + (1.0f - t) * (1.0f + t)));
}
[[nodiscard]] inline float cosine_coordinate(float cos_theta, float alpha_of_row) {
    const float a = 4.0f * std::max(alpha_of_row, kSmallestAlpha);
    return std::sqrt(cos_theta * (1.0f + a) / (cos_theta + a)) * (kCosines - 1);
}

[[nodiscard]] inline float share_cosine(int node) {
    const float t = fraction(node, kCosines);
    return t * t;
}
[[nodiscard]] inline float share_cosine_coordinate(float cos_theta) {
    return std::sqrt(cos_theta) * (kCosines - 1);
}

[[nodiscard]] inline float eta(int node, int count) {
    const float t = fraction(node, count);
    const float root = kLargestR0Root * t * t * t;
    return (1.0f + root) / (1.0f - root);
}
/// For eta >= 1.
[[nodiscard]] inline float eta_coordinate(float e, int count) {
    return std::cbrt((e - 1.0f) / (e + 1.0f) / kLargestR0Root) * static_cast<float>(count - 1);
}

/// Between nodes `index` and `index + 1`, at `t` in [0, 1].
struct Place {
    std::size_t index;
    float t;
};

[[nodiscard]] inline Place place(float coordinate, int count) {
    const float clamped = std::clamp(coordinate, 0.0f, static_cast<float>(count - 1));
    const int index = std::min(static_cast<int>(clamped), count - 2);
    return {static_cast<std::size_t>(index), clamped - static_cast<float>(index)};
}

[[nodiscard]] inline float mix(float a, float b, float t) {
    return a + (b - a) * t;
}

template <std::size_t Alphas>
[[nodiscard]] float interpolate(const std::array<std::array<float, kCosines>, Alphas>& slice, Place a, Place c) {
    const auto& low = slice[a.index];
    const auto& high = slice[a.index + 1];
    return mix(mix(low[c.index], low[c.index + 1], c.t), mix(high[c.index], high[c.index + 1], c.t), a.t);
}
[[nodiscard]] inline float interpolate(const Averages& averages, Place a) {
    return mix(averages[a.index], averages[a.index + 1], a.t);
}

}  // namespace etendue::ggx_albedo_layout
