#include "metrics/color_map.h"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace etendue {
namespace {

TEST(ColorMap, MagmaHasThePublishedColors) {
    // From the table of matplotlib's map, times 255.
    EXPECT_EQ(magma(0.0f), (DisplayColor{0, 0, 4}));
    EXPECT_EQ(magma(64.0f / 255.0f), (DisplayColor{81, 18, 124}));
    EXPECT_EQ(magma(128.0f / 255.0f), (DisplayColor{183, 55, 121}));
    EXPECT_EQ(magma(192.0f / 255.0f), (DisplayColor{252, 137, 97}));
    EXPECT_EQ(magma(1.0f), (DisplayColor{252, 253, 191}));
    EXPECT_EQ(magma(7.0f), magma(1.0f));
    EXPECT_EQ(magma(-1.0f), magma(0.0f));
    EXPECT_EQ(magma(std::numeric_limits<float>::quiet_NaN()), magma(0.0f));
}

TEST(ColorMap, BrightensAllTheWay) {
    const auto brightness = [](const DisplayColor& c) { return 0.3 * c.r + 0.59 * c.g + 0.11 * c.b; };
    for (int i = 1; i < 256; ++i)
        EXPECT_GT(brightness(magma(static_cast<float>(i) / 255.0f)),
                  brightness(magma(static_cast<float>(i - 1) / 255.0f)) - 1.0)
            << i;
}

TEST(ColorMap, PaintsFromZeroToTheLargest) {
    ImageF map(3, 1, 1);
    map.pixels = {0.0f, 4.0f, 4.0f};
    const std::vector<std::uint8_t> left_out{0, 0, 1};
    const ImageF painted = paint_magma(map, 4.0, left_out);
    ASSERT_EQ(painted.channels, 3);
    EXPECT_FLOAT_EQ(painted.pixel(0, 0)[2], 4.0f / 255.0f);
    EXPECT_FLOAT_EQ(painted.pixel(1, 0)[0], 252.0f / 255.0f);
    EXPECT_FLOAT_EQ(painted.pixel(2, 0)[1], static_cast<float>(kLeftOutColor.g) / 255.0f);
}

}  // namespace
}  // namespace etendue
