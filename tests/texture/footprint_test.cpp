#include "texture/footprint.h"

#include "core/wide.h"
#include "support/random.h"

#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

float length(Vec2f v) {
    return std::sqrt(v.x * v.x + v.y * v.y);
}

constexpr Vec2f kSize(64.0f, 64.0f);

/// A circle of `diameter` texels in a square image of 64.
FilterTaps<float> circle(float diameter) {
    return plan_taps<float>({diameter / 64.0f, 0.0f}, {0.0f, diameter / 64.0f}, kSize);
}

TEST(Footprint, ACircleTakesTheLevelOfItsDiameter) {
    EXPECT_FALSE(circle(0.7f).minified);
    EXPECT_FALSE(plan_taps<float>(Vec2f(0.0f), Vec2f(0.0f), kSize).minified);
    for (const float diameter : {1.5f, 2.0f, 4.0f, 10.0f, 64.0f, 1000.0f}) {
        const FilterTaps<float> taps = circle(diameter);
        EXPECT_TRUE(taps.minified);
        EXPECT_EQ(taps.count, 1);
        EXPECT_NEAR(taps.level, std::log2(diameter), 1e-4f) << diameter;
    }
}

TEST(Footprint, AnEllipseTakesTheLevelOfItsWidthAndTapsAlongItsLength) {
    // 4 × 24 texels along u, in an image that is twice as wide as high.
    const FilterTaps<float> taps = plan_taps<float>({24.0f / 128.0f, 0.0f}, {0.0f, 4.0f / 64.0f}, {128.0f, 64.0f});
    EXPECT_EQ(taps.count, 6);
    EXPECT_NEAR(taps.level, 2.0f, 1e-5f);
    EXPECT_NEAR(std::abs(taps.step.x), 4.0f / 128.0f, 1e-6f);
    EXPECT_NEAR(taps.step.y, 0.0f, 1e-6f);
}

TEST(Footprint, EllipsesThatAreTooLongAreWidened) {
    const FilterTaps<float> taps = plan_taps<float>({0.0f, 2.0f}, {0.01f / 64.0f, 0.0f}, kSize);
    EXPECT_EQ(taps.count, kMaxTaps);
    EXPECT_NEAR(taps.level, std::log2(128.0f / kMaxTaps), 1e-4f);
    EXPECT_NEAR(length(taps.step) * taps.count, 2.0f, 1e-4f);
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
        const FilterTaps<float> expected = plan_taps(a, b, kSize);
        const float phase = 2.0f * kPi * random.next();
        const FilterTaps<float> taps = plan_taps<float>(a * std::cos(phase) + b * std::sin(phase),
                                                        b * std::cos(phase) - a * std::sin(phase), kSize);
        EXPECT_LE(std::abs(taps.count - expected.count), 1);
        EXPECT_NEAR(length(taps.step) * taps.count, major / 64.0f, 0.02f * major / 64.0f);
        const float across = (taps.step.x * b.x + taps.step.y * b.y) / (length(b) * length(taps.step));
        EXPECT_NEAR(across, 0.0f, 0.02f);
    }
}

TEST(Footprint, WhatIsNoNumberOrInfiniteTakesTheCoarsestLevel) {
    const float infinity = std::numeric_limits<float>::infinity();
    for (const float bad : {infinity, -infinity, std::numeric_limits<float>::quiet_NaN(), 3e38f}) {
        const FilterTaps<float> taps = plan_taps<float>({bad, 0.0f}, {0.0f, 0.1f}, kSize);
        EXPECT_TRUE(taps.minified);
        EXPECT_EQ(taps.count, 1);
        EXPECT_GT(taps.level, 20.0f);
    }
}

TEST(Footprint, TapsOfManyAtOnceAreThoseOfEach) {
    const auto plan = [](const auto& in) {
        using T = std::remove_cvref_t<decltype(in[0])>;
        // From a tenth of a texel to sixteen images.
        const auto size = [](T u) { return u * u * u * T(16.0f) + T(0.1f / 64.0f); };
        const FilterTaps<T> taps =
            plan_taps<T>({size(in[0]), in[1] * size(in[0])}, {in[2] * size(in[3]), size(in[3])}, {T(64.0f), T(64.0f)});
        return std::array{taps.count, taps.step.x, taps.step.y, taps.level, select(taps.minified, T(1.0f), T(0.0f))};
    };
    // Numbers of taps differ where rounding decides; a fourth of the ellipses takes one.
    int same = 0;
    constexpr int kCalls = 20'000;
    Random random(5);
    for (int call = 0; call < kCalls; ++call) {
        const std::array in{random.next(), random.next(), random.next(), random.next()};
        const auto expected = plan(in);
        const auto found = plan(std::array{Wide(in[0]), Wide(in[1]), Wide(in[2]), Wide(in[3])});
        ASSERT_EQ(found[4][0], expected[4]);
        ASSERT_NEAR(found[0][0], expected[0], 1.0f);
        if (found[0][0] != expected[0]) continue;
        ++same;
        for (const std::size_t o : {1u, 2u, 3u})
            ASSERT_NEAR(found[o][0], expected[o], 1e-3f * std::abs(expected[o]) + 1e-5f);
    }
    EXPECT_GT(same, kCalls - 20);
}

}  // namespace

}  // namespace etendue::test
