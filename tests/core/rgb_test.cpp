#include "core/rgb.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace etendue {

namespace {

TEST(Rgb, CalculatesChannelByChannel) {
    const Rgb a{1.0f, 2.0f, 3.0f};
    const Rgb b{4.0f, 5.0f, 8.0f};
    EXPECT_EQ(a + b, Rgb(5.0f, 7.0f, 11.0f));
    EXPECT_EQ(b - a, Rgb(3.0f, 3.0f, 5.0f));
    EXPECT_EQ(a * b, Rgb(4.0f, 10.0f, 24.0f));
    EXPECT_EQ(b / a, Rgb(4.0f, 2.5f, 8.0f / 3.0f));
    EXPECT_EQ(a * 2.0f, 2.0f * a);
    EXPECT_EQ(b / 4.0f, Rgb(1.0f, 1.25f, 2.0f));
    EXPECT_EQ(lerp(a, b, 0.0f), a);
    EXPECT_EQ(lerp(a, b, 1.0f), b);
    EXPECT_EQ(lerp(a, b, 0.5f), Rgb(2.5f, 3.5f, 5.5f));
}

TEST(Rgb, Summarises) {
    const Rgb c{0.5f, 2.0f, 0.2f};
    EXPECT_EQ(max_component(c), 2.0f);
    EXPECT_EQ(min_component(c), 0.2f);
    EXPECT_NEAR(average(c), 0.9f, 1e-6f);
    EXPECT_TRUE(is_black(Rgb()));
    EXPECT_FALSE(is_black({0.0f, 1e-30f, 0.0f}));
    EXPECT_TRUE(is_finite(c));
    EXPECT_FALSE(is_finite(Rgb(0.0f, std::numeric_limits<float>::infinity(), 0.0f)));
    EXPECT_FALSE(is_finite(Rgb(0.0f, 0.0f, std::nanf(""))));
}

}  // namespace

}  // namespace etendue
