#include "core/ray.h"

#include <cmath>

#include <gtest/gtest.h>

namespace etendue {

namespace {

TEST(OffsetOrigin, GoesToTheSideOfTheDirection) {
    const Vec3f n{0.0f, 0.0f, 1.0f};
    EXPECT_GT(offset_origin({0.0f, 0.0f, 0.0f}, n, {0.5f, 0.0f, 0.5f}).z, 0.0f);
    EXPECT_LT(offset_origin({0.0f, 0.0f, 0.0f}, n, {0.5f, 0.0f, -0.5f}).z, 0.0f);
}

// Relative to a point's size the step is many roundings, yet invisible: between 10 and 100 units in the last place.
TEST(OffsetOrigin, ScalesWithTheCoordinates) {
    const Vec3f n = normalize({1.0f, 2.0f, 3.0f});
    for (const float size : {1e-3f, 1.0f, 1e3f, 1e6f}) {
        const Vec3f p{size, -0.3f * size, 0.1f * size};
        const float step = length(offset_origin(p, n, n) - p);
        const float ulp = std::nextafter(size, 2.0f * size) - size;
        EXPECT_GT(step, 10.0f * ulp) << size;
        EXPECT_LT(step, 100.0f * ulp) << size;
    }
    EXPECT_GT(length(offset_origin(Vec3f(0.0f), n, n)), 0.0f) << "also at the origin";
}

}  // namespace

}  // namespace etendue
