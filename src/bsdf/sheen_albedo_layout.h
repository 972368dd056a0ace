// Where the nodes of the sheen's albedo tables lie: shared by the program that computes them and the code that reads
// them.
#pragma once

#include "bsdf/ggx_albedo_layout.h"

#include <array>
#include <cmath>

namespace etendue::sheen_albedo_layout {

using ggx_albedo_layout::fraction;
using ggx_albedo_layout::interpolate;
using ggx_albedo_layout::mix;
using ggx_albedo_layout::Place;
using ggx_albedo_layout::place;

inline constexpr int kCosines = 128;  ///< cosines mu = t³, densest at grazing angles, where the fibres' albedo rises
inline constexpr int kAlphas = 48;    ///< values of alpha = t², from kSmallestSheenAlpha
inline constexpr float kSmallestSheenAlpha = 0.01f;

using Table = std::array<std::array<float, kCosines>, kAlphas>;

[[nodiscard]] inline float alpha(int node) {
    const float first = std::sqrt(kSmallestSheenAlpha);
    const float t = mix(first, 1.0f, fraction(node, kAlphas));
    return t * t;
}
[[nodiscard]] inline Place<float> alpha_place(float a) {
    const float first = std::sqrt(kSmallestSheenAlpha);
    return place((std::sqrt(a) - first) / (1.0f - first) * (kAlphas - 1), kAlphas);
}
[[nodiscard]] inline float cosine(int node) {
    const float t = fraction(node, kCosines);
    return t * t * t;
}
[[nodiscard]] inline Place<float> cosine_place(float mu) {
    return place(std::cbrt(mu) * (kCosines - 1), kCosines);
}

/// Everything that the program computes, as it lies in its file and in memory.
struct Tables {
    Table unbounded;
    Table bounded;
};

}  // namespace etendue::sheen_albedo_layout
