#include "image/displayed.h"

#include "core/error.h"
#include "image_test_files.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue {
namespace {

/// An EXR of one channel with the values 1, 2, … whose pixels lie at (x, y) of a display window of 4 by 3 at (10, 20).
std::filesystem::path exr(const TemporaryFolder& folder, int x, int y, int width, int height) {
    OIIO::ImageSpec spec(width, height, 1, OIIO::TypeDesc::HALF);
    spec.x = 10 + x;
    spec.y = 20 + y;
    spec.full_x = 10;
    spec.full_y = 20;
    spec.full_width = 4;
    spec.full_height = 3;
    std::vector<float> values;
    values.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    for (int i = 0; i < width * height; ++i) values.push_back(static_cast<float>(i + 1));
    return write_reference(folder / "a.exr", spec, values);
}

using Values = std::vector<float>;

TEST(DisplayedImage, PixelsAreWhereTheDisplayWindowHasThem) {
    const TemporaryFolder folder;
    const auto path = exr(folder, 1, 2, 2, 1);
    const ImageInfo info = read_displayed_info(path);
    EXPECT_EQ(info.width, 4);
    EXPECT_EQ(info.height, 3);
    const ImageF image = read_displayed_float(path);
    EXPECT_EQ(image.pixels, (Values{0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 2, 0}));
    const std::vector<NativeImage> levels = read_displayed_levels(path);
    ASSERT_EQ(levels.size(), 1u);
    const auto& half = std::get<ImageH>(levels[0]);
    EXPECT_EQ(half.width, 4);
    EXPECT_EQ(static_cast<float>(half.pixel(2, 2)[0]), 2.0f);
    EXPECT_EQ(static_cast<float>(half.pixel(0, 0)[0]), 0.0f);
}

TEST(DisplayedImage, WhatLiesBeyondTheDisplayWindowIsLeftOut) {
    const TemporaryFolder folder;
    EXPECT_EQ(read_displayed_float(exr(folder, -1, -1, 2, 2)).pixels, (Values{4, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}));
    EXPECT_EQ(read_displayed_float(exr(folder, 40, 0, 2, 2)).pixels, Values(12, 0.0f));
}

TEST(DisplayedImage, WholeImagesAreAsTheyAre) {
    const TemporaryFolder folder;
    const ImageF image = read_displayed_float(exr(folder, 0, 0, 4, 3));
    EXPECT_EQ(image.pixels, (Values{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}));
    // What a TIFF says of its place on a page moves nothing.
    OIIO::ImageSpec spec(2, 1, 1, OIIO::TypeDesc::FLOAT);
    spec.x = 5;
    spec.full_width = 8;
    const auto tiff = write_reference(folder / "a.tif", spec, Values{1, 2});
    EXPECT_EQ(read_displayed_float(tiff).pixels, (Values{1, 2}));
}

TEST(DisplayedImage, AnEmptyCanvasWithoutEndIsRefused) {
    const TemporaryFolder folder;
    OIIO::ImageSpec spec(2, 2, 1, OIIO::TypeDesc::FLOAT);
    spec.full_width = 16000;
    spec.full_height = 16000;
    const auto path = write_reference(folder / "a.exr", spec, Values{1, 2, 3, 4});
    try {
        (void)read_displayed_float(path);
        FAIL();
    } catch (const IoError& error) {
        EXPECT_NE(std::string(error.what()).find("far larger than the 2 x 2 pixels"), std::string::npos);
    }
}

}  // namespace
}  // namespace etendue
