#include "metrics/not_finite.h"

#include "metrics/error_metrics.h"

#include <limits>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace etendue {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

TEST(NotFinite, IsCountedAndFound) {
    ImageF image(6, 4, 3);
    EXPECT_EQ(find_not_finite(image).count(), 0u);
    image.pixel(4, 1)[2] = kNan;
    image.pixel(2, 1)[0] = kInfinity;
    image.pixel(3, 3)[1] = -kInfinity;
    image.pixel(3, 3)[2] = kNan;
    const NotFinite found = find_not_finite(image);
    EXPECT_EQ(found.nan, 2u);
    EXPECT_EQ(found.infinite, 1u);
    EXPECT_EQ(found.bounds, (PixelRect{2, 1, 5, 4}));
    EXPECT_EQ(found.first, (std::vector<Vec2i>{{2, 1}, {4, 1}, {3, 3}}));
}

TEST(NotFinite, OnlyTheFirstAreListed) {
    ImageF image(100, 1, 1);
    image.pixels.assign(image.pixels.size(), kNan);
    const NotFinite found = find_not_finite(image);
    EXPECT_EQ(found.count(), 100u);
    EXPECT_EQ(found.first.size(), NotFinite::kMostFirst);
}

TEST(NotFinite, MarkedPixelsCanBeLeftOut) {
    ImageF image(4, 1, 2);
    ImageF reference(4, 1, 2);
    image.pixels = {1.0f, 1.0f, kNan, 1.0f, 1.0f, 1.0f, 3.0f, 3.0f};
    reference.pixels = {1.0f, 1.0f, 1.0f, 1.0f, 1.0f, kInfinity, 1.0f, 1.0f};
    const std::vector<std::uint8_t> marks = mark_not_finite(image, reference);
    EXPECT_EQ(marks, (std::vector<std::uint8_t>{0, 1, 1, 0}));
    EXPECT_DOUBLE_EQ(compute_error_metrics(image, reference, {.left_out = marks}).mse, 2.0);
    blank(image, marks);
    EXPECT_EQ(image.pixels, (std::vector<float>{1.0f, 1.0f, 0.0f, 0.0f, 0.0f, 0.0f, 3.0f, 3.0f}));
    EXPECT_THROW((void)mark_not_finite(image, ImageF(3, 1, 2)), std::invalid_argument);
}

}  // namespace
}  // namespace etendue
