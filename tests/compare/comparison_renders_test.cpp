#include "compare/comparison_renders.h"

#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

TEST(RenderSeed, CountsOnFromRoundToRound) {
    EXPECT_EQ(render_seed(5, 0, 0, 3), 5u);
    EXPECT_EQ(render_seed(5, 0, 2, 3), 7u);
    EXPECT_EQ(render_seed(5, 1, 0, 3), 8u);
    EXPECT_EQ(render_seed(0xffffffffu, 0, 1, 2), 0u) << "after the last there is";
}

TEST(FitSamples, ComesNearestToTheTime) {
    EXPECT_EQ(fit_samples(16, 10.0, 0.1), 16u);
    EXPECT_EQ(fit_samples(16, 0.74, 0.1), 7u);
    EXPECT_EQ(fit_samples(16, 0.06, 0.1), 1u) << "a sample more ends nearer";
    EXPECT_EQ(fit_samples(16, 0.04, 0.1), 0u);
    EXPECT_EQ(fit_samples(16, 0.0, 0.0), 0u);
    EXPECT_EQ(fit_samples(16, 1.0, 0.0), 16u) << "samples of no time all fit";
}

TEST(CalibratedSamples, AreTheMedianOfWhatRendersSay) {
    const std::vector<SampleCost> costs{{1.0, 0.1}, {2.0, 0.2}, {9.0, 4.0}};
    EXPECT_EQ(calibrated_samples(10.0, costs), 41u) << "2 s of the first sample, and 40 of 0.2 s; one render was slow";
    EXPECT_EQ(calibrated_samples(1.5, costs), 1u) << "no render has less";
    EXPECT_EQ(calibrated_samples(10.0, std::vector<SampleCost>{{0.0, 0.0}}), 1u << 24) << "the most there are";
}

TEST(CorrectedSamples, TakeTheTimeThatWasMissed) {
    EXPECT_EQ(corrected_samples(7, 2.45, 4.0), 11u);
    EXPECT_EQ(corrected_samples(7, 3.3, 4.0), 7u) << "within a fifth";
    EXPECT_EQ(corrected_samples(1, 9.0, 4.0), 1u) << "no render has less";
    EXPECT_EQ(corrected_samples(9, 0.0, 4.0), 9u) << "no time tells nothing";
}

TEST(LeastSeconds, AreThoseOfAllRendersOnTheClock) {
    RendersRequest request{.budget = {.seconds = 8.0}, .seeds = 3};
    EXPECT_DOUBLE_EQ(least_seconds(2, request, 4), 12.0) << "8 s of CPU time on four threads, six times";
    request.budget.by_wall = true;
    EXPECT_DOUBLE_EQ(least_seconds(2, request, 4), 48.0);
    request.budget = {.spp = 5};
    EXPECT_EQ(least_seconds(2, request, 4), 0.0) << "samples take a time that is not known";
}

}  // namespace

}  // namespace etendue::test
