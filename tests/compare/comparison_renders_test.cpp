#include "compare/comparison_renders.h"

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

}  // namespace

}  // namespace etendue::test
