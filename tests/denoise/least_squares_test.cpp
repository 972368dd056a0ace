// Small linear systems.
#include "denoise/least_squares.h"

#include <cmath>

#include <gtest/gtest.h>

namespace etendue {

namespace {

/// M Mᵀ + I of a matrix of sines, and right-hand sides that `solution` solves.
NormalEquations make_equations(int unknowns, double (*solution)(std::size_t channel, std::size_t unknown)) {
    NormalEquations equations;
    equations.unknowns = unknowns;
    const auto n = static_cast<std::size_t>(unknowns);
    std::array<std::array<double, kMostUnknowns>, kMostUnknowns> full{};
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) {
            full[i][j] = i == j ? 1.0 : 0.0;
            for (std::size_t k = 0; k < n; ++k)
                full[i][j] += std::sin(double(3 * i + 7 * k)) * std::sin(double(3 * j + 7 * k));
        }
    equations.matrix = full;
    for (std::size_t c = 0; c < kFitChannels; ++c)
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < n; ++j) equations.right_hand_side[c][i] += full[i][j] * solution(c, j);
    return equations;
}

TEST(LeastSquares, SolvesWhatHasASolution) {
    const auto solution = [](std::size_t channel, std::size_t unknown) {
        return double(channel) - 0.5 * double(unknown);
    };
    for (const int unknowns : {1, 3, 10, kMostUnknowns}) {
        NormalEquations equations = make_equations(unknowns, solution);
        solve(equations);
        for (std::size_t c = 0; c < kFitChannels; ++c)
            for (std::size_t i = 0; i < static_cast<std::size_t>(unknowns); ++i)
                EXPECT_NEAR(equations.right_hand_side[c][i], solution(c, i), 1e-10) << unknowns;
    }
}

TEST(LeastSquares, WhatIsDeterminedByOthersBecomesZero) {
    NormalEquations equations;  // the second unknown is twice the first, the fourth is nothing
    equations.unknowns = 4;
    equations.matrix[0] = {1.0};
    equations.matrix[1] = {2.0, 4.0};
    equations.matrix[2] = {0.0, 0.0, 9.0};
    equations.matrix[3] = {0.0, 0.0, 0.0, 0.0};
    equations.right_hand_side[0] = {5.0, 10.0, 18.0, 0.0};
    solve(equations);
    EXPECT_EQ(equations.right_hand_side[0][0], 5.0);
    EXPECT_EQ(equations.right_hand_side[0][1], 0.0);
    EXPECT_EQ(equations.right_hand_side[0][2], 2.0);
    EXPECT_EQ(equations.right_hand_side[0][3], 0.0);
}

}  // namespace

}  // namespace etendue
