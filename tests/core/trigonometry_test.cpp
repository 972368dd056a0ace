#include "core/trigonometry.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace etendue {

namespace {

TEST(SinCos, OfAFractionOfATurn) {
    for (int i = 0; i <= 100'000; ++i) {
        const float turns = static_cast<float>(i) / 100'000.0f;
        const double angle = 2.0 * std::numbers::pi * static_cast<double>(turns);
        const SinCos result = sin_cos_turns(turns);
        ASSERT_NEAR(static_cast<double>(result.sin), std::sin(angle), 3e-7) << turns;
        ASSERT_NEAR(static_cast<double>(result.cos), std::cos(angle), 3e-7) << turns;
    }
}

TEST(SinCos, OfAnOctant) {
    for (int i = -1000; i <= 1000; ++i) {
        const float x = kPi / 4.0f * static_cast<float>(i) / 1000.0f;
        const SinCos result = sin_cos_octant(x);
        ASSERT_NEAR(static_cast<double>(result.sin), std::sin(static_cast<double>(x)), 1.2e-7) << x;
        ASSERT_NEAR(static_cast<double>(result.cos), std::cos(static_cast<double>(x)), 1.2e-7) << x;
    }
}

}  // namespace

}  // namespace etendue
