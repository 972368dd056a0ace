#include "core/position_error.h"

#include "support/random.h"

#include <cmath>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

// Points of random triangles, in single and in double precision: the difference along the normal stays below the
// clearance, which is not more than a few dozen roundings of the largest coordinate.
TEST(PositionError, ClearsTheRoundingOfInterpolatedPoints) {
    Random random(1);
    const auto coordinate = [&](float size) { return (2.0f * random.next() - 1.0f) * size; };
    for (int i = 0; i < 20'000; ++i) {
        const float size = std::pow(10.0f, 8.0f * random.next() - 4.0f);
        const Vec3f p[3] = {{coordinate(size), coordinate(size), coordinate(size)},
                            {coordinate(size), coordinate(size), coordinate(size)},
                            {coordinate(size), coordinate(size), coordinate(size)}};
        const Vec2f b{0.5f * random.next(), 0.5f * random.next()};
        const Vec3f point = p[0] + (p[1] - p[0]) * b.x + (p[2] - p[0]) * b.y;
        const Imath::V3d exact = Imath::V3d(p[0]) + (Imath::V3d(p[1]) - Imath::V3d(p[0])) * static_cast<double>(b.x) +
                                 (Imath::V3d(p[2]) - Imath::V3d(p[0])) * static_cast<double>(b.y);
        const Imath::V3d normal =
            (Imath::V3d(p[1]) - Imath::V3d(p[0])).cross(Imath::V3d(p[2]) - Imath::V3d(p[0])).normalized();
        const Vec3f extent =
            max_components(abs_components(p[0]), max_components(abs_components(p[1]), abs_components(p[2])));
        const float distance = clearance(Vec3f(normal), position_error(extent));
        ASSERT_LT(std::abs((Imath::V3d(point) - exact).dot(normal)), static_cast<double>(distance));
        ASSERT_LT(distance, 2e-6f * size + 2e-9f);
    }
}

TEST(PositionError, CountsEveryTermOfATransform) {
    Mat4f far_and_back;
    far_and_back[3][0] = -100.0f;
    const Vec3f error = position_error(Vec3f(100.0f, 1.0f, 1.0f), far_and_back);
    EXPECT_GT(error.x, 100.0f * 0x1p-24f) << "although the point is near the origin in the end";
    EXPECT_LT(error.y, 10.0f * kPositionError);
}

TEST(PositionError, AFlatFloorAtTheOriginNeedsNextToNothing) {
    EXPECT_EQ(clearance({0.0f, 1.0f, 0.0f}, position_error({1e4f, 0.0f, 1e4f})), 1e-9f);
}

}  // namespace

}  // namespace etendue::test
