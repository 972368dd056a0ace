#include "support/t_test.h"

#include "support/random.h"

#include <array>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

TEST(TTest, MatchesAPublishedTable) {
    // Mean 1, standard error sqrt(10 / 4 / 5): the table's t for 4 degrees of freedom at 5% is 2.776.
    const std::array samples{-1.0, 0.0, 1.0, 2.0, 3.0};
    const double error = 0.70710678;
    const TTestResult result = t_test(samples, 1.0 - 2.776 * error);
    EXPECT_NEAR(result.t, 2.776, 1e-6);
    EXPECT_NEAR(result.p_value, 0.05, 1e-4);
}

TEST(TTest, AcceptsTheTrueMeanAndRejectsAnother) {
    Random random(5);
    std::vector<double> samples(10'000);
    for (double& sample : samples) sample = static_cast<double>(random.next());
    EXPECT_GT(t_test(samples, 0.5).p_value, 0.01) << t_test(samples, 0.5).str();
    EXPECT_LT(t_test(samples, 0.52).p_value, 1e-6);
    EXPECT_GT(t_test(samples, 0.52, 0.02).p_value, 0.01);
}

TEST(TTest, SamplesWithoutVarianceMustHitTheToleranceExactly) {
    const std::array samples{0.5, 0.5, 0.5};
    EXPECT_EQ(t_test(samples, 0.5).p_value, 1.0);
    EXPECT_EQ(t_test(samples, 0.501, 0.01).p_value, 1.0);
    EXPECT_EQ(t_test(samples, 0.501).p_value, 0.0);
}

TEST(TTest, NotANumberFails) {
    const std::array samples{0.5, std::numeric_limits<double>::quiet_NaN(), 0.5};
    EXPECT_EQ(t_test(samples, 0.5, 10.0).p_value, 0.0);
}

}  // namespace

}  // namespace etendue::test
