// Two halves of the samples, and the variance that they show.
#include "denoise/halves.h"

#include "denoise/test_planes.h"

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

double mean(const Planes& planes) {
    double sum = 0.0;
    for (int y = 0; y < planes.height(); ++y)
        for (int x = 0; x < planes.width(); ++x) sum += double(planes.row(0, y)[x]);
    return sum / (double(planes.width()) * planes.height());
}

TEST(Halves, TheOtherHalfIsWhatTheWholeLacks) {
    const Planes a = same_planes(7, 5, 3, [](int x, int y) { return float(x + 10 * y); });
    const Planes b = same_planes(7, 5, 3, [](int x, int y) { return float(3 * y - x); });
    for (const float share : {0.5f, 0.25f, 0.7f}) {
        const Halves halves = make_halves(mean_of_all(a, b, share), a, share);
        EXPECT_LT(largest_difference(halves.a, a), 1e-9) << share;
        EXPECT_LT(largest_difference(halves.b, b), 1e-4) << share;
    }
}

TEST(Halves, AreBlackIfNeitherHasAnything) {
    const Planes black = same_planes(7, 5, 3, [](int, int) { return 0.0f; });
    const Planes spark = same_planes(7, 5, 3, [](int x, int y) { return x == 6 && y == 4 ? 1.0f : 0.0f; });
    EXPECT_TRUE(is_black(make_halves(black, black, 0.5f)));
    EXPECT_FALSE(is_black(make_halves(spark, black, 0.5f)));
    EXPECT_FALSE(is_black(make_halves(mean_of_all(spark, black, 0.5f), spark, 0.5f)));
}

TEST(Halves, VarianceHasTheRightMeanForEveryShare) {
    const Planes grey = same_planes(128, 128, 1, [](int, int) { return 0.5f; });
    for (const float share : {0.5f, 0.25f, 0.8f}) {
        const Halves halves = noisy_halves(grey, 0.1f, 7, share);
        // 16384 squares of normal numbers: their mean has a relative deviation of 1.1%.
        EXPECT_NEAR(mean(halves.variance), 0.01, 0.0005) << share;
    }
}

TEST(Halves, ScalesSayWhatAHalfVaries) {
    const Planes grey = same_planes(128, 128, 1, [](int, int) { return 0.5f; });
    const Halves halves = noisy_halves(grey, 0.1f, 9, 0.2f);
    EXPECT_NEAR(mean_squared_difference(halves.a, grey), 0.01 * double(halves.variance_scale_a()), 0.0025);
    EXPECT_NEAR(mean_squared_difference(halves.b, grey), 0.01 * double(halves.variance_scale_b()), 0.0007);
}

TEST(Halves, BoxesAverageAndRepeatTheEdge) {
    const Planes step = same_planes(8, 4, 1, [](int x, int) { return x < 4 ? 0.0f : 1.0f; });
    const Planes smooth = box_filtered(step, 1);
    EXPECT_NEAR(smooth.row(0, 0)[3], 1.0f / 3.0f, 1e-6f);
    EXPECT_NEAR(smooth.row(0, 3)[4], 2.0f / 3.0f, 1e-6f);
    EXPECT_NEAR(smooth.row(0, 0)[7], 1.0f, 1e-6f);
    EXPECT_EQ(smooth.row(0, 0)[0], 0.0f);
}

TEST(Planes, BordersRepeatTheNearestPixel) {
    const Planes planes = make_planes(3, 2, 2, [](int plane, int x, int y) { return float(100 * plane + 10 * y + x); });
    EXPECT_EQ(planes.row(1, -kPlaneBorder)[-kPlaneBorder], 100.0f);
    EXPECT_EQ(planes.row(0, 1 + kPlaneBorder)[2 + kPlaneBorder], 12.0f);
    EXPECT_EQ(planes.row(1, 1)[2 + kPlaneBorder], 112.0f);
    EXPECT_EQ(planes.row(1, 1 + kPlaneBorder)[1], 111.0f);
}

TEST(Planes, ChannelsGoInAndOut) {
    ImageF image(3, 2, 4);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = static_cast<float>(i);
    const std::vector<int> channels{2, 0};
    const Planes planes(image, channels);
    EXPECT_EQ(planes.row(0, 1)[2], image.pixel(2, 1)[2]);
    EXPECT_EQ(planes.row(1, 0)[1], image.pixel(1, 0)[0]);
    ImageF back(3, 2, 4);
    planes.copy_to(back, channels);
    EXPECT_EQ(back.pixel(2, 1)[2], image.pixel(2, 1)[2]);
    EXPECT_EQ(back.pixel(1, 0)[0], image.pixel(1, 0)[0]);
    EXPECT_EQ(back.pixel(1, 0)[3], 0.0f);
}

}  // namespace

}  // namespace etendue::test
