#include "image/scale_down.h"

#include "core/error.h"
#include "image/write.h"
#include "image_test_files.h"

#include <filesystem>
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

TEST(ReadScaledDown, IsTheImageScaledDown) {
    const TemporaryFolder folder;
    ImageF image = ramp(37, 23, 3);
    for (float& value : image.pixels) value /= 37.0f * 23.0f * 3.0f;
    write_image(folder / "a.png", image, {.depth = PixelDepth::UInt8});
    for (const int width : {1, 10, 36, 37, 100}) {
        const ImageF small = read_scaled_down(folder / "a.png", width);
        const ImageF expected = scale_down(read_image_float(folder / "a.png"), width);
        EXPECT_EQ(small.height, expected.height);
        EXPECT_EQ(small.pixels, expected.pixels) << width;
    }
}

TEST(ReadScaledDown, RefusesWhatIsBroken) {
    const TemporaryFolder folder;
    EXPECT_THROW((void)read_scaled_down(folder / "none.png", 10), IoError);
    write_image(folder / "a.png", ramp(40, 40, 3), {.depth = PixelDepth::UInt8});
    std::filesystem::resize_file(folder / "a.png", std::filesystem::file_size(folder / "a.png") / 2);
    EXPECT_THROW((void)read_scaled_down(folder / "a.png", 10), IoError);
}

}  // namespace

}  // namespace etendue
