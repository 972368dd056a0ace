// Small systems of normal equations.
#pragma once

#include <array>
#include <cstddef>

namespace etendue {

/// Most unknowns of a fit: a constant, two coordinates, and the channels of features.
inline constexpr int kMostUnknowns = 3 + 16;
/// Channels that are fitted together.
inline constexpr int kFitChannels = 3;

/// A β = r for `unknowns` unknowns and kFitChannels right-hand sides, A symmetric and positive definite.
struct NormalEquations {
    int unknowns = 0;
    std::array<std::array<double, kMostUnknowns>, kMostUnknowns> matrix{};          ///< lower triangle only
    std::array<std::array<double, kMostUnknowns>, kFitChannels> right_hand_side{};  ///< becomes β
};

/// Solves them in place by A = L Lᵀ (Cholesky). An unknown whose pivot has vanished next to its diagonal element, since
/// those before determine it, becomes 0.
void solve(NormalEquations& equations);

}  // namespace etendue
