#include "texture/footprint.h"

#include "support/random.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

float length(Vec2f v) {
    return std::sqrt(v.x * v.x + v.y * v.y);
}

/// A circle of `diameter` texels in a square image of 64.
FilterTaps circle(float diameter) {
    return plan_taps({{{diameter / 64.0f, 0.0f}, {0.0f, diameter / 64.0f}}}, 64, 64);
}

TEST(Footprint, ACircleTakesTheLevelOfItsDiameter) {
    EXPECT_FALSE(circle(0.7f).minified);
    EXPECT_FALSE(plan_taps({}, 64, 64).minified);
    for (const float diameter : {1.5f, 2.0f, 4.0f, 10.0f, 64.0f, 1000.0f}) {
        const FilterTaps taps = circle(diameter);
        EXPECT_TRUE(taps.minified);
        EXPECT_EQ(taps.count, 1);
        EXPECT_NEAR(taps.level, std::log2(diameter), 1e-4f) << diameter;
    }
}

TEST(Footprint, AnEllipseTakesTheLevelOfItsWidthAndTapsAlongItsLength) {
    // 4 × 24 texels along u, in an image that is twice as wide as high.
    const FilterTaps taps = plan_taps({{{24.0f / 128.0f, 0.0f}, {0.0f, 4.0f / 64.0f}}}, 128, 64);
    EXPECT_EQ(taps.count, 6);
    EXPECT_NEAR(taps.level, 2.0f, 1e-5f);
    EXPECT_NEAR(std::abs(taps.step.x), 4.0f / 128.0f, 1e-6f);
    EXPECT_NEAR(taps.step.y, 0.0f, 1e-6f);
}

TEST(Footprint, EllipsesThatAreTooLongAreWidened) {
    const FilterTaps taps = plan_taps({{{0.0f, 2.0f}, {0.01f / 64.0f, 0.0f}}}, 64, 64);
    EXPECT_EQ(taps.count, kMaxTaps);
    EXPECT_NEAR(taps.level, std::log2(128.0f / static_cast<float>(kMaxTaps)), 1e-4f);
    EXPECT_NEAR(length(taps.step) * static_cast<float>(taps.count), 2.0f, 1e-4f);
}

// Any pair of conjugate diameters describes the same ellipse, hence the same taps.
TEST(Footprint, ConjugateDiametersOfOneEllipseGiveTheSameTaps) {
    Random random(3);
    for (int i = 0; i < 200; ++i) {
        const float major = 4.0f + 40.0f * random.next();
        const float minor = 1.5f + 2.0f * random.next();
        const float turn = 2.0f * kPi * random.next();
        const Vec2f a = Vec2f(std::cos(turn), std::sin(turn)) * (major / 64.0f);
        const Vec2f b = Vec2f(-std::sin(turn), std::cos(turn)) * (minor / 64.0f);
        const FilterTaps expected = plan_taps({{a, b}}, 64, 64);
        const float phase = 2.0f * kPi * random.next();
        const FilterTaps taps =
            plan_taps({{a * std::cos(phase) + b * std::sin(phase), b * std::cos(phase) - a * std::sin(phase)}}, 64, 64);
        EXPECT_LE(std::abs(taps.count - expected.count), 1);
        EXPECT_NEAR(length(taps.step) * static_cast<float>(taps.count), major / 64.0f, 0.02f * major / 64.0f);
        const float across = (taps.step.x * b.x + taps.step.y * b.y) / (length(b) * length(taps.step));
        EXPECT_NEAR(across, 0.0f, 0.02f);
    }
}

TEST(Footprint, WhatIsNoNumberOrInfiniteTakesTheCoarsestLevel) {
    const float infinity = std::numeric_limits<float>::infinity();
    for (const float bad : {infinity, -infinity, std::numeric_limits<float>::quiet_NaN(), 3e38f}) {
        const FilterTaps taps = plan_taps({{{bad, 0.0f}, {0.0f, 0.1f}}}, 64, 64);
        EXPECT_TRUE(taps.minified);
        EXPECT_EQ(taps.count, 1);
        EXPECT_GT(taps.level, 20.0f);
    }
}

}  // namespace

}  // namespace etendue::test
