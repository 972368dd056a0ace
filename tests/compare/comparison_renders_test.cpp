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

}  // namespace

}  // namespace etendue::test
