#include "image/scale_down.h"

#include <numeric>
#include <vector>

#include <gtest/gtest.h>

namespace etendue {

namespace {

ImageF ramp(int width, int height, int channels) {
    ImageF image(width, height, channels);
    std::iota(image.pixels.begin(), image.pixels.end(), 0.0f);
    return image;
}

TEST(ScaleDown, PixelsAreMeansOfTheirBoxes) {
    const ImageF half = scale_down(ramp(4, 2, 1), 2);
    EXPECT_EQ(half.width, 2);
    EXPECT_EQ(half.height, 1);
    EXPECT_EQ(half.pixels, (std::vector<float>{2.5f, 4.5f}));
}

TEST(ScaleDown, ChannelsStayApart) {
    const ImageF one = scale_down(ramp(2, 2, 3), 1);
    EXPECT_EQ(one.pixels, (std::vector<float>{4.5f, 5.5f, 6.5f}));
}

TEST(ScaleDown, WhatIsSmallEnoughStays) {
    const ImageF image = ramp(5, 3, 1);
    EXPECT_EQ(scale_down(image, 5).pixels, image.pixels);
    EXPECT_EQ(scale_down(image, 50).pixels, image.pixels);
}

// Seven columns into three, and a line that would have no row.
TEST(ScaleDown, UnevenBoxesCoverAllPixels) {
    const ImageF image = ramp(7, 1, 1);
    const ImageF small = scale_down(image, 3);
    EXPECT_EQ(small.height, 1);
    EXPECT_EQ(small.pixels, (std::vector<float>{0.5f, 2.5f, 5.0f}));
}

}  // namespace

}  // namespace etendue
