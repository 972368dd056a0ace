// Multiple importance sampling of two strategies (Veach 1997, section 9.2). Densities are those of one sample each, or
// times the samples that a strategy takes of them.
#pragma once

namespace etendue {

/// Returns the weight, by the power heuristic with exponent 2 (equation 9.9), of a sample drawn with density `pdf` when
/// the other strategy has `other_pdf`, both in the same measure. A ratio keeps large densities from overflowing.
template <typename T>
[[nodiscard]] constexpr T power_heuristic(T pdf, T other_pdf) {
    const T ratio = other_pdf / pdf;
    return 1.0f / (1.0f + ratio * ratio);
}

}  // namespace etendue
