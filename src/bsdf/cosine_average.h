// Means over a cosine-weighted hemisphere, for lobes whose albedos have no table.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace etendue {

/// Returns ∫ f(x) dx over x in [0, 1], by Gauss-Legendre's rule of five points. `f` returns anything that can be added
/// and scaled.
template <typename Function>
[[nodiscard]] auto unit_average(const Function& f) {
    constexpr std::array<float, 5> kNodes{0.046910077f, 0.230765345f, 0.5f, 0.769234655f, 0.953089923f};
    constexpr std::array<float, 5> kWeights{0.118463443f, 0.239314335f, 0.284444444f, 0.239314335f, 0.118463443f};
    auto sum = f(kNodes[0]) * kWeights[0];
    for (std::size_t i = 1; i < kNodes.size(); ++i) sum += f(kNodes[i]) * kWeights[i];
    return sum;
}

/// Returns 2 ∫ f(mu) mu dmu over mu in [0, 1], a plain mean in mu². `f` returns anything that can be added and scaled.
template <typename Function>
[[nodiscard]] auto cosine_average(const Function& f) {
    return unit_average([&](float squared) { return f(std::sqrt(squared)); });
}

}  // namespace etendue
