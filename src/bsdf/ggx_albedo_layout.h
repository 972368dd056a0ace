// Where the nodes of the albedo tables lie: shared by the program that computes them and the code that reads them.
#pragma once

#include <cmath>

namespace etendue::ggx_albedo_layout {

inline constexpr int kCosines = 32;  ///< cos theta = t², t in [0, 1]: dense near grazing
inline constexpr int kAlphas = 32;   ///< alpha = t², t in [0, 1]: uniform in perceptual roughness
inline constexpr int kEtas = 12;     ///< uniform in (eta - 1) / (eta + 1), from eta = 1 to 3, for each side

/// (3 - 1) / (3 + 1)
inline constexpr float kLargestR0Root = 0.5f;

[[nodiscard]] inline float cosine(int node) {
    const float t = static_cast<float>(node) / (kCosines - 1);
    return t * t;
}
[[nodiscard]] inline float alpha(int node) {
    const float t = static_cast<float>(node) / (kAlphas - 1);
    return t * t;
}
[[nodiscard]] inline float eta(int node) {
    const float t = kLargestR0Root * static_cast<float>(node) / (kEtas - 1);
    return (1.0f + t) / (1.0f - t);
}

[[nodiscard]] inline float cosine_coordinate(float cos_theta) { return std::sqrt(cos_theta) * (kCosines - 1); }
[[nodiscard]] inline float alpha_coordinate(float a) { return std::sqrt(a) * (kAlphas - 1); }
/// For eta >= 1.
[[nodiscard]] inline float eta_coordinate(float e) { return (e - 1.0f) / (e + 1.0f) / kLargestR0Root * (kEtas - 1); }

}  // namespace etendue::ggx_albedo_layout
