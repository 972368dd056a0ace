#include "core/ray.h"

#include <gtest/gtest.h>

namespace etendue {

namespace {

TEST(OffsetOrigin, GoesToTheSideOfTheDirection) {
    const Vec3f p{1.0f, 2.0f, 3.0f};
    const Vec3f n{0.0f, 0.0f, 1.0f};
    EXPECT_EQ(offset_origin(p, n, 0.5f, {0.5f, 0.0f, 0.5f}), Vec3f(1.0f, 2.0f, 3.5f));
    EXPECT_EQ(offset_origin(p, n, 0.5f, {0.5f, 0.0f, -0.5f}), Vec3f(1.0f, 2.0f, 2.5f));
}

}  // namespace

}  // namespace etendue
