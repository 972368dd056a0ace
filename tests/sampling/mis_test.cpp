#include "sampling/mis.h"

#include <limits>

#include <gtest/gtest.h>

namespace etendue {

namespace {

TEST(Mis, WeightsOfBothStrategiesSumToOne) {
    for (const float a : {1e-20f, 1e-3f, 0.5f, 1.0f, 7.0f, 1e10f, 1e30f})
        for (const float b : {1e-20f, 1e-3f, 0.5f, 1.0f, 7.0f, 1e10f, 1e30f})
            EXPECT_NEAR(power_heuristic(a, b) + power_heuristic(b, a), 1.0f, 1e-6f) << a << " " << b;
}

TEST(Mis, FollowsVeachsEquation) {
    EXPECT_FLOAT_EQ(power_heuristic(1.0f, 3.0f), 0.1f);
}

TEST(Mis, AStrategyAloneHasAllTheWeight) {
    EXPECT_EQ(power_heuristic(2.0f, 0.0f), 1.0f);
    EXPECT_EQ(power_heuristic(0.0f, 2.0f), 0.0f);
    EXPECT_EQ(power_heuristic(1.0f, std::numeric_limits<float>::infinity()), 0.0f) << "the other is a delta";
}

}  // namespace

}  // namespace etendue
