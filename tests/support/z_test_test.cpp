#include "support/z_test.h"

#include <limits>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

TEST(ZTest, MatchesAPublishedTable) {
    const ZTestResult result = z_test({1.0 + 1.959964 * 0.5, 0.16}, {1.0, 0.09});
    EXPECT_NEAR(result.z, 1.959964, 1e-9);
    EXPECT_NEAR(result.p_value, 0.05, 1e-6);
}

TEST(ZTest, DeviationsWithinTheToleranceCountAsNone) {
    EXPECT_EQ(z_test({1.0, 0.0}, {1.1, 0.0}, 0.2).p_value, 1.0);
    EXPECT_EQ(z_test({1.0, 0.0}, {1.1, 0.0}).p_value, 0.0);
}

TEST(ZTest, NotANumberFails) {
    EXPECT_EQ(z_test({std::numeric_limits<double>::quiet_NaN(), 1.0}, {0.0, 1.0}, 10.0).p_value, 0.0);
    EXPECT_EQ(z_test({1.0, std::numeric_limits<double>::quiet_NaN()}, {0.0, 1.0}).p_value, 0.0);
}

}  // namespace

}  // namespace etendue::test
