// Collaborative regression on images whose answer is known.
#include "denoise/regression.h"

#include "denoise/test_planes.h"

#include <cmath>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

const ThreadPool kSingleThread(1);
constexpr NlMeansSettings kWindows{9, 3, 1.0f};

float texture(int plane, int x, int y) {
    return std::sin(0.9f * float(x) + float(plane)) * std::cos(0.7f * float(y) - float(plane));
}

TEST(Regression, WhatIsLinearInFeaturesAndPositionIsExact) {
    const Planes features = make_planes(50, 41, 4, texture);
    // The weights tell no pixels apart; the target is a linear function, another for each channel.
    const Planes flat = same_planes(50, 41, 3, [](int, int) { return 1.0f; });
    const Planes variance = same_planes(50, 41, 3, [](int, int) { return 0.01f; });
    const Planes target = make_planes(50, 41, 3, [&](int plane, int x, int y) {
        const auto c = static_cast<float>(plane + 1);
        return 5.0f + 0.1f * float(x) - 0.05f * c * float(y) + c * texture(0, x, y) - 0.5f * texture(1, x, y) +
               0.25f * c * texture(3, x, y);
    });
    const Planes fitted = collaborative_regression({target, {flat, variance}, features}, kWindows, kSingleThread);
    EXPECT_LT(largest_difference(fitted, target), 1e-4);
}

TEST(Regression, WithoutFeaturesItIsLinearInPosition) {
    const Planes flat = same_planes(30, 30, 3, [](int, int) { return 1.0f; });
    const Planes ramp = same_planes(30, 30, 3, [](int x, int y) { return 0.5f * float(x) + 0.25f * float(y); });
    const Planes fitted = collaborative_regression({ramp, {flat, flat}, Planes(30, 30, 0)}, kWindows, kSingleThread);
    EXPECT_LT(largest_difference(fitted, ramp), 1e-4);
}

TEST(Regression, ConstantAndRepeatedFeaturesDoNoHarm) {
    const Planes features = make_planes(40, 40, 4, [](int plane, int x, int y) {
        return plane == 0 ? 0.7f : plane == 3 ? 0.0f : texture(1, x, y);
    });
    const Planes flat = same_planes(40, 40, 3, [](int, int) { return 1.0f; });
    const Planes target = same_planes(40, 40, 3, [](int x, int y) { return 2.0f + texture(1, x, y); });
    const Planes fitted = collaborative_regression({target, {flat, flat}, features}, kWindows, kSingleThread);
    EXPECT_LT(largest_difference(fitted, target), 1e-4);
}

TEST(Regression, IsTheSameForEveryNumberOfThreads) {
    const Planes truth = same_planes(90, 70, 3, [](int x, int y) { return float((x / 16 + y / 16) % 2); });
    const Halves halves = noisy_halves(truth, 0.3f, 11);
    const RegressionInput input{halves.a, {halves.b, halves.variance, halves.variance_scale_b()}, truth};
    const Planes one = collaborative_regression(input, kWindows, kSingleThread);
    EXPECT_EQ(largest_difference(one, collaborative_regression(input, kWindows, ThreadPool(4))), 0.0);
    EXPECT_EQ(largest_difference(one, collaborative_regression(input, kWindows, ThreadPool(3))), 0.0);
}

TEST(Regression, ImagesSmallerThanAWindow) {
    for (const int side : {1, 2, 5}) {
        const Planes truth = same_planes(side, side, 3, [](int, int) { return 0.5f; });
        const Planes fitted = collaborative_regression({truth, {truth, truth}, truth}, {16, 3, 1.0f}, kSingleThread);
        EXPECT_LT(largest_difference(fitted, truth), 1e-6) << side;
    }
}

}  // namespace

}  // namespace etendue::test
