#include "output/auto_exposure.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace etendue {
namespace {

/// An image of grey pixels, a hundred of them for each entry.
ImageF grey(const std::vector<float>& values) {
    ImageF image(100, static_cast<int>(values.size()), 4);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const auto pixel = image.pixel(x, y);
            for (int c = 0; c < 3; ++c) pixel[std::size_t(c)] = values[std::size_t(y)];
            pixel[3] = 1.0f;
        }
    return image;
}

TEST(AutoExposure, LeavesWhatLooksRight) {
    EXPECT_EQ(choose_exposure(grey({0.18f, 0.5f, 0.45f})).stops, 0.0f);
    EXPECT_EQ(choose_exposure(grey({1.4f})).stops, 0.0f);
}

TEST(AutoExposure, BringsHighlightsIntoRange) {
    EXPECT_NEAR(choose_exposure(grey({4.0f, 6.0f})).stops, -2.0f, 0.006f) << "6 becomes 1.5";
    EXPECT_NEAR(choose_exposure(grey({0.05f, 0.1f})).stops, 2.0f, 0.006f) << "0.1 becomes 0.4";
    EXPECT_NEAR(choose_exposure(grey({3072.0f})).stops, -11.0f, 0.006f);
    EXPECT_EQ(choose_exposure(grey({1e-30f})).stops, 20.0f);
}

TEST(AutoExposure, RaisesADarkMedian) {
    // A bright window in a dark room: 3 of 10 rows.
    const std::vector<float> room{3, 3, 3, 0.015f, 0.015f, 0.015f, 0.015f, 0.015f, 0.015f, 0.015f};
    EXPECT_NEAR(choose_exposure(grey(room)).stops, 1.0f, 0.006f) << "the median becomes 0.03";
    std::vector<float> darker(10, 1e-5f);
    darker[0] = 3.0f;
    EXPECT_NEAR(choose_exposure(grey(darker)).stops, 3.0f, 0.006f) << "by three stops at most";
}

TEST(AutoExposure, IsNotLedAwayByLampsInView) {
    std::vector<float> lit(10, 0.5f);
    lit[0] = 1e5f;
    EXPECT_NEAR(choose_exposure(grey(lit)).stops, std::log2(1.5f / 8.0f), 0.006f) << "16 times 0.5 becomes 1.5";
}

TEST(AutoExposure, CountsNeitherBlackNorBrokenPixels) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_NEAR(choose_exposure(grey({0.0f, 0.0f, 0.0f, 0.1f, nan})).stops, 2.0f, 0.006f);
    EXPECT_EQ(choose_exposure(grey({0.0f})).stops, 0.0f);
    EXPECT_EQ(choose_exposure(grey({0.0f})).reason, "the image is black");
}

TEST(AutoExposure, IsForFramesWithoutOne) {
    OutputFrame frame;
    frame.pixels = grey({0.1f});
    choose_missing_exposure(frame);
    EXPECT_NEAR(frame.exposure.value(), 2.0f, 0.006f);
    EXPECT_EQ(frame.exposure_reason, "half of it is darker than 0.1, and its highlights end at 0.1");
    frame.exposure = 0.5f;
    choose_missing_exposure(frame);
    EXPECT_EQ(frame.exposure.value(), 0.5f);
}

}  // namespace
}  // namespace etendue
