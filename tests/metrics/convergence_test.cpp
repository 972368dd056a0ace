#include "metrics/convergence.h"

#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <gtest/gtest.h>

namespace etendue {

namespace {

/// error = scale × work^exponent.
std::vector<ErrorAfter> power_law(double scale, double exponent, int points = 8) {
    std::vector<ErrorAfter> result;
    for (int i = 0; i < points; ++i) {
        const double work = 0.3 * std::pow(2.0, i);
        result.push_back({work, scale * std::pow(work, exponent)});
    }
    return result;
}

TEST(LogLogSlope, IsTheExponent) {
    for (const double exponent : {-1.0, -0.5, 0.25})
        EXPECT_NEAR(log_log_slope(power_law(3.0, exponent)).value(), exponent, 1e-12);
}

TEST(LogLogSlope, LeavesOutWhatHasNoLogarithm) {
    std::vector<ErrorAfter> points = power_law(2.0, -1.0);
    points.push_back({5.0, 0.0});
    points.push_back({0.0, 5.0});
    points.push_back({7.0, std::numeric_limits<double>::quiet_NaN()});
    EXPECT_NEAR(log_log_slope(points).value(), -1.0, 1e-12);
}

TEST(LogLogSlope, IsOfALineThatFits) {
    std::vector<ErrorAfter> points = power_law(1.0, -1.0);
    for (ErrorAfter& point : points) point.error += 0.1;
    EXPECT_FALSE(log_log_slope(points)) << "errors that stop falling, as of light that is missing";
    points = power_law(1.0, -1.0);
    for (std::size_t i = 0; i < points.size(); ++i) points[i].error *= i % 2 == 0 ? 1.1 : 1.0 / 1.1;
    EXPECT_NEAR(log_log_slope(points).value(), -1.0, 0.05) << "scatter of 10%";
    EXPECT_FALSE(log_log_slope(std::span(points).first(2))) << "a line through two points fits whatever they are";
}

TEST(LogLogSlope, NeedsSeveralPlaces) {
    EXPECT_FALSE(log_log_slope({}));
    EXPECT_FALSE(log_log_slope(std::vector<ErrorAfter>{{1.0, 2.0}}));
    EXPECT_FALSE(log_log_slope(std::vector<ErrorAfter>{{1.0, 2.0}, {1.0, 3.0}}));
}

TEST(WorkToReach, LiesBetweenThePoints) {
    const std::vector<ErrorAfter> points = power_law(3.0, -1.0);
    const auto reached = work_to_reach(points, 3.0 / 2.0);
    ASSERT_TRUE(reached);
    EXPECT_NEAR(reached->work, 2.0, 1e-9);
    EXPECT_FALSE(reached->extrapolated);
}

TEST(WorkToReach, IsTheFirstPointIfThatIsGoodEnough) {
    const std::vector<ErrorAfter> points = power_law(3.0, -1.0);
    EXPECT_EQ(work_to_reach(points, 1e3)->work, points.front().work);
}

TEST(WorkToReach, GoesOnAlongTheSlope) {
    const auto reached = work_to_reach(power_law(3.0, -1.0), 3.0 / 500.0);
    ASSERT_TRUE(reached);
    EXPECT_NEAR(reached->work, 500.0, 1e-6);
    EXPECT_TRUE(reached->extrapolated);
}

TEST(WorkToReach, NeverWhereErrorsDoNotFall) {
    EXPECT_FALSE(work_to_reach(power_law(3.0, 0.1), 1e-3));
    EXPECT_FALSE(work_to_reach({}, 1.0));
    EXPECT_FALSE(work_to_reach(power_law(3.0, -1.0), 0.0));
    EXPECT_FALSE(work_to_reach(std::vector<ErrorAfter>{{1.0, 2.0}}, 1.0)) << "one point has no slope";
}

}  // namespace

}  // namespace etendue
