#include "denoise/least_squares.h"

#include <cmath>

namespace etendue {

namespace {

/// Pivots below this share of the diagonal element that they come from are rounding.
constexpr double kVanished = 1e-13;

}  // namespace

void solve(NormalEquations& equations) {
    const auto n = static_cast<std::size_t>(equations.unknowns);
    auto& l = equations.matrix;
    for (std::size_t j = 0; j < n; ++j) {
        double pivot = l[j][j];
        for (std::size_t k = 0; k < j; ++k) pivot -= l[j][k] * l[j][k];
        const bool vanished = !(pivot > kVanished * l[j][j]);
        // As if the column were that of an unknown that nothing depends on.
        l[j][j] = vanished ? 1.0 : std::sqrt(pivot);
        if (vanished)
            for (std::size_t k = 0; k < j; ++k) l[j][k] = 0.0;
        for (std::size_t i = j + 1; i < n; ++i) {
            double sum = vanished ? 0.0 : l[i][j];
            for (std::size_t k = 0; k < j; ++k) sum -= l[i][k] * l[j][k];
            l[i][j] = vanished ? 0.0 : sum / l[j][j];
        }
        if (vanished)
            for (auto& r : equations.right_hand_side) r[j] = 0.0;
    }
    for (auto& r : equations.right_hand_side) {
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t k = 0; k < i; ++k) r[i] -= l[i][k] * r[k];
            r[i] /= l[i][i];
        }
        for (std::size_t i = n; i-- > 0;) {
            for (std::size_t k = i + 1; k < n; ++k) r[i] -= l[k][i] * r[k];
            r[i] /= l[i][i];
        }
    }
}

}  // namespace etendue
