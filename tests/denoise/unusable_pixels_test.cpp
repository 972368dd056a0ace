// Pixels that are filled from those around them.
#include "denoise/unusable_pixels.h"

#include "denoise/test_planes.h"

#include <limits>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

TEST(UnusablePixels, AreFilledFromTheirNeighbours) {
    Planes whole = same_planes(30, 20, 3, [](int x, int) { return float(x); });
    Planes half = same_planes(30, 20, 3, [](int x, int) { return float(2 * x); });
    whole.row(1, 5)[7] = kNan;
    half.row(2, 5)[20] = -kInfinity;
    whole.row(0, 0)[0] = 1e16f;
    EXPECT_EQ(fill_unusable(whole, half), 3u);
    for (int plane = 0; plane < 3; ++plane) {
        EXPECT_EQ(whole.row(plane, 5)[7], 7.0f);
        EXPECT_EQ(half.row(plane, 5)[7], 14.0f);
        EXPECT_EQ(whole.row(plane, 5)[20], 20.0f);
        EXPECT_EQ(half.row(plane, 5)[20], 40.0f);
        EXPECT_NEAR(whole.row(plane, 0)[0], 2.0f / 3.0f, 1e-6f);
    }
}

TEST(UnusablePixels, HolesAreFilledFromTheirRim) {
    Planes whole =
        same_planes(60, 60, 1, [](int x, int y) { return x > 5 && x < 40 && y > 5 && y < 40 ? kNan : 2.0f; });
    Planes half = same_planes(60, 60, 1, [](int, int) { return 2.0f; });
    EXPECT_EQ(fill_unusable(whole, half), 34u * 34u);
    EXPECT_EQ(whole.row(0, 13)[13], 2.0f);
    EXPECT_EQ(whole.row(0, 22)[22], 0.0f) << "too far from any";
}

TEST(UnusablePixels, TheBackgroundComesNear) {
    Planes whole = same_planes(4, 3, 2, [](int x, int) { return x == 0 ? 1e10f : float(x); });
    Planes half = same_planes(4, 3, 2, [](int x, int) { return x < 2 ? 1e10f : float(x); });
    bring_background_near(whole, half);
    for (const int plane : {0, 1}) {
        EXPECT_FLOAT_EQ(whole.row(plane, 2)[0], 3.3f);
        EXPECT_EQ(whole.row(plane, 2)[3], 3.0f);
        EXPECT_FLOAT_EQ(half.row(plane, 2)[1], 3.3f);
        EXPECT_EQ(half.row(plane, 2)[2], 2.0f);
    }
    Planes nothing = same_planes(2, 2, 1, [](int, int) { return 1e10f; });
    Planes same = nothing;
    bring_background_near(nothing, same);
    EXPECT_EQ(nothing.row(0, 1)[1], 0.0f);
}

TEST(UnusablePixels, GoodImagesStayAsTheyAre) {
    Planes whole = same_planes(10, 10, 3, [](int x, int y) { return 1e14f * float(x - y); });
    const Planes before = whole;
    Planes half = whole;
    EXPECT_EQ(fill_unusable(whole, half), 0u);
    EXPECT_EQ(largest_difference(whole, before), 0.0);
}

}  // namespace

}  // namespace etendue::test
