#include "metrics/pixel_selection.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace etendue {
namespace {

/// 0, 1, 2 … by rows.
ImageF counted(int width, int height) {
    ImageF image(width, height, 1);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = static_cast<float>(i);
    return image;
}

TEST(PixelSelection, IsARectangleWithoutSomePixels) {
    const ImageF image = counted(4, 3);
    std::vector<std::uint8_t> left_out(12);
    left_out[6] = 1;
    left_out[0] = 1;
    std::vector<std::size_t> pixels;
    for_each_pixel(image, {.region = PixelRect{1, 1, 3, 3}, .left_out = left_out},
                   [&](std::size_t pixel) { pixels.push_back(pixel); });
    EXPECT_EQ(pixels, (std::vector<std::size_t>{5, 9, 10}));
}

TEST(PixelSelection, MeansAndQuantilesAreOfWhatIsSelected) {
    const ImageF image = counted(10, 10);
    EXPECT_DOUBLE_EQ(mean_of(image), 49.5);
    EXPECT_DOUBLE_EQ(mean_of(image, {.region = PixelRect{0, 1, 10, 2}}), 14.5);
    EXPECT_DOUBLE_EQ(quantile_of(image, 0.0), 0.0);
    EXPECT_DOUBLE_EQ(quantile_of(image, 1.0), 99.0);
    EXPECT_DOUBLE_EQ(quantile_of(image, 0.5), 50.0);
    EXPECT_DOUBLE_EQ(quantile_of(image, 1.0, {.region = PixelRect{0, 0, 5, 1}}), 4.0);
}

TEST(PixelSelection, OfNothingHasNoMean) {
    const ImageF image = counted(2, 1);
    const std::vector<std::uint8_t> all{1, 1};
    EXPECT_TRUE(std::isnan(mean_of(image, {.left_out = all})));
    EXPECT_TRUE(std::isnan(quantile_of(image, 0.5, {.left_out = all})));
    ImageF broken = image;
    broken.pixels[0] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(std::isnan(quantile_of(broken, 0.5)));
}

}  // namespace
}  // namespace etendue
