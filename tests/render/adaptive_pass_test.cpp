// To which pixels samples go, for variances that are made up.
#include "render/adaptive_pass.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace etendue {

namespace {

constexpr std::uint32_t kNoLimit = 1u << 24;

double error_of(const std::vector<float>& variance, const std::vector<float>& samples, double light_path) {
    double eye = 0.0;
    double paths = 0.0;
    for (std::size_t p = 0; p < samples.size(); ++p) {
        eye += static_cast<double>(variance[p]) / static_cast<double>(samples[p]);
        paths += static_cast<double>(samples[p]);
    }
    return eye / static_cast<double>(samples.size()) + light_path / paths;
}

/// What `variance` leaves after `samples` everywhere, and one light path variance `light_path` in the whole image.
Allocation after(const std::vector<std::uint32_t>& samples, const std::vector<float>& variance, double light_path,
                 double target) {
    const std::vector<float> taken(samples.begin(), samples.end());
    return {.variance = variance,
            .samples = samples,
            .eye_error = error_of(variance, taken, 0.0),
            .light_error = light_path / static_cast<double>(std::accumulate(samples.begin(), samples.end(), 0u)),
            .target = target,
            .most = kNoLimit};
}

TEST(SampleGoals, AreThoseOfNeyman) {
    const std::vector<float> variance{1.0f, 4.0f, 9.0f, 16.0f};
    const std::vector<std::uint32_t> samples(4, 1);
    const std::vector<float> goals = sample_goals(after(samples, variance, 0.0, 0.01));
    // c = mean(sqrt(e)) / target = 2.5 / 0.01
    for (std::size_t p = 0; p < 4; ++p) EXPECT_NEAR(goals[p], 250.0f * std::sqrt(variance[p]), 0.02f * goals[p]) << p;
    EXPECT_LE(error_of(variance, goals, 0.0), 0.01);
}

TEST(SampleGoals, WhereNobodyKnowsOfTheNoiseAllGetAsMuch) {
    // A single pixel has no neighbour.
    const std::vector<float> unknown{0.0f};
    const std::vector<std::uint32_t> taken{48};
    const Allocation one{.variance = unknown, .samples = taken, .eye_error = 0.01, .target = 0.0001, .most = kNoLimit};
    EXPECT_NEAR(sample_goals(one).at(0), 4800.0f, 48.0f);
}

TEST(PassUpTo, GivesNobodyMoreThanAskedFor) {
    const AdaptiveState state{.passes = 3, .samples = {48, 80, 64, 200}};
    const AdaptivePass pass = pass_up_to(state, 96);
    EXPECT_EQ(pass.is_active, (std::vector<std::uint8_t>{1, 1, 1, 0}));
    EXPECT_EQ(pass.active, 3u);
    EXPECT_EQ(pass.count, 16u);
}

TEST(SampleGoals, LightPathsOnlyScaleThem) {
    const std::vector<float> variance{1.0f, 4.0f, 9.0f, 16.0f};
    const std::vector<std::uint32_t> samples(4, 1);
    constexpr double kLight = 20.0;
    const std::vector<float> goals = sample_goals(after(samples, variance, kLight, 0.01));
    // c = (mean(sqrt(e)) + l / sum(sqrt(e))) / target = (2.5 + 20 / 10) / 0.01
    for (std::size_t p = 0; p < 4; ++p) EXPECT_NEAR(goals[p], 450.0f * std::sqrt(variance[p]), 0.02f * goals[p]) << p;
    EXPECT_LE(error_of(variance, goals, kLight), 0.01);
}

TEST(SampleGoals, AreAllTheSameWithoutNoiseOfTheEye) {
    const std::vector<float> variance(5, 0.0f);
    const std::vector<std::uint32_t> samples(5, 10);
    for (const float goal : sample_goals(after(samples, variance, 5.0, 0.01))) EXPECT_NEAR(goal, 100.0f, 2.0f);
}

TEST(SampleGoals, KeepWhatIsTakenAndStayBelowTheMost) {
    const std::vector<float> variance{1.0f, 1.0f, 1.0f, 100.0f};
    const std::vector<std::uint32_t> samples{400, 8, 8, 8};
    Allocation allocation = after(samples, variance, 0.0, 0.1);
    std::vector<float> goals = sample_goals(allocation);
    EXPECT_EQ(goals[0], 400.0f);
    EXPECT_LE(error_of(variance, goals, 0.0), 0.1);
    EXPECT_GE(error_of(variance, goals, 0.0), 0.097) << "and not more than that";
    EXPECT_NEAR(goals[3], 10.0f * goals[1], 0.1f);
    // The others make up for what the last one may not have.
    allocation.most = 300;
    const float before = goals[1];
    goals = sample_goals(allocation);
    EXPECT_EQ(goals[3], 300.0f);
    EXPECT_GT(goals[1], before);
    allocation.target = 1e-6;
    EXPECT_EQ(sample_goals(allocation), (std::vector<float>{400.0f, 300.0f, 300.0f, 300.0f})) << "cannot be reached";
}

TEST(SampleGoals, LeaveNoPixelFarBehind) {
    std::vector<float> variance(100, 0.0f);
    variance[0] = 1.0f;
    const std::vector<std::uint32_t> samples(100, 1);
    const std::vector<float> goals = sample_goals(after(samples, variance, 0.0, 1e-6));
    const float mean = std::accumulate(goals.begin(), goals.end(), 0.0f) / 100.0f;
    for (const float goal : goals) EXPECT_GE(goal, 0.1f * mean);
}

// The scale of the variances is that of what was measured: a neighbourhood that promises too much asks for no more.
TEST(SampleGoals, TrustWhatWasMeasured) {
    const std::vector<float> variance{1.0f, 4.0f, 9.0f, 16.0f};
    const std::vector<float> tenfold{10.0f, 40.0f, 90.0f, 160.0f};
    const std::vector<std::uint32_t> samples(4, 1);
    Allocation allocation = after(samples, variance, 3.0, 0.01);
    const std::vector<float> goals = sample_goals(allocation);
    allocation.variance = tenfold;
    const std::vector<float> same = sample_goals(allocation);
    for (std::size_t p = 0; p < 4; ++p) EXPECT_NEAR(same[p], goals[p], 0.02f * goals[p]);
}

TEST(VarianceAround, IsThatOfTheNeighboursAndNeverItsOwn) {
    constexpr int kWidth = 20;
    constexpr int kHeight = 15;
    const auto at = [](int x, int y) { return static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x); };
    std::vector<float> variance(kWidth * kHeight, 0.0f);
    variance[at(10, 7)] = 24.0f;
    const std::vector<float> around = variance_around(variance, kWidth, kHeight, ThreadPool(2));
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const bool is_near = std::abs(x - 10) <= 3 && std::abs(y - 7) <= 3;
            const bool is_own = x == 10 && y == 7;
            EXPECT_FLOAT_EQ(around[at(x, y)], is_near && !is_own ? 1.0f : 0.0f) << x << ", " << y;
        }
    EXPECT_EQ(variance_around(std::vector<float>{5.0f}, 1, 1, ThreadPool(2)), std::vector<float>{0.0f})
        << "nothing around it";
}

TEST(VarianceAround, IsTheLargestOfTheMeans) {
    std::mt19937 random(3);
    std::vector<float> variance(9 * 7);
    for (float& value : variance) value = static_cast<float>(random() % 100);
    const std::vector<float> around = variance_around(variance, 9, 7, ThreadPool(2));
    for (int y = 0; y < 7; ++y)
        for (int x = 0; x < 9; ++x) {
            double largest = 0.0;
            for (int j = std::max(0, y - 1); j <= std::min(6, y + 1); ++j)
                for (int i = std::max(0, x - 1); i <= std::min(8, x + 1); ++i) {
                    double sum = 0.0;
                    int count = 0;
                    for (int v = std::max(0, j - 2); v <= std::min(6, j + 2); ++v)
                        for (int u = std::max(0, i - 2); u <= std::min(8, i + 2); ++u) {
                            if (u == x && v == y) continue;
                            const int neighbour = v * 9 + u;
                            sum += static_cast<double>(variance[static_cast<std::size_t>(neighbour)]);
                            ++count;
                        }
                    largest = std::max(largest, sum / count);
                }
            EXPECT_NEAR(around[static_cast<std::size_t>(y * 9 + x)], largest, 1e-3) << x << ", " << y;
        }
}

TEST(AdaptivePass, IsForThePixelsThatNeedIt) {
    constexpr int kSide = 16;
    RenderState state{.film = Film(kSide, kSide, {0, 0, kSide, kSide}), .spp_done = 64};
    ErrorEstimate errors;
    for (int p = 0; p < kSide * kSide; ++p) errors.eye.push_back(p % kSide < 4 ? 0.1f : 1e-4f);
    errors.eye_mean = std::accumulate(errors.eye.begin(), errors.eye.end(), 0.0) / (kSide * kSide);
    const AdaptivePass pass = plan_adaptive_pass(state, errors, 0.9 * errors.relative_error(), 100, ThreadPool(2));
    EXPECT_EQ(pass.count, 16u);
    ASSERT_EQ(pass.is_active.size(), errors.eye.size());
    EXPECT_EQ(pass.active,
              static_cast<std::uint32_t>(std::accumulate(pass.is_active.begin(), pass.is_active.end(), 0)));
    for (int p = 0; p < kSide * kSide; ++p) {
        const int column = p % kSide;
        if (column >= 4 && column < 8) continue;
        EXPECT_EQ(pass.is_active[static_cast<std::size_t>(p)], column < 4 ? 1 : 0) << p;
    }
    // Fewer are left than a pass has, then none.
    EXPECT_EQ(plan_adaptive_pass(state, errors, 1e-4, 70, ThreadPool(2)).count, 6u);
    EXPECT_EQ(plan_adaptive_pass(state, errors, 1e-4, 64, ThreadPool(2)).active, 0u);
}

}  // namespace

}  // namespace etendue
