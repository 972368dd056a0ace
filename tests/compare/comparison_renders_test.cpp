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

}  // namespace

}  // namespace etendue::test
