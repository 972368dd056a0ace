#include "scene/transform.h"

#include <limits>

#include <gtest/gtest.h>

namespace etendue {
namespace {

Mat4f scaled(float x, float y, float z) {
    Mat4f m;
    m[0][0] = x;
    m[1][1] = y;
    m[2][2] = z;
    return m;
}

TEST(IsInvertible, AcceptsMirrorsAndSmallScales) {
    EXPECT_TRUE(is_invertible(Mat4f()));
    EXPECT_TRUE(is_invertible(scaled(-1, 1, 1)));
    EXPECT_TRUE(is_invertible(scaled(1e-6f, 1e-6f, 1e-6f)));
    EXPECT_TRUE(is_invertible(scaled(1e4f, 1e-4f, 1)));
}

TEST(IsInvertible, RefusesCollapsedAxes) {
    EXPECT_FALSE(is_invertible(scaled(1, 0, 1)));
    EXPECT_FALSE(is_invertible(scaled(1e-20f, 1e-20f, 1e-20f)));
    Mat4f sheared;
    sheared[1][0] = 1.0f;
    sheared[1][1] = 0.0f;  // y lies on x
    EXPECT_FALSE(is_invertible(sheared));
}

TEST(IsInvertible, RefusesProjectionsAndNan) {
    Mat4f projective;
    projective[2][3] = 0.1f;
    EXPECT_FALSE(is_invertible(projective));
    Mat4f bad;
    bad[3][1] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(is_invertible(bad));
}

TEST(RigidPart, RemovesScaleAndKeepsTheViewDirection) {
    Mat4f m;  // x along world -z, z along world x, scaled unevenly
    m = Mat4f(0, 0, -3, 0, 0, 2, 0, 0, 5, 0, 0, 0, 7, 8, 9, 1);
    const std::optional<Mat4f> rigid = rigid_part(m);
    ASSERT_TRUE(rigid);
    EXPECT_NEAR((*rigid)[2][0], 1.0f, 1e-6f);
    EXPECT_NEAR((*rigid)[1][1], 1.0f, 1e-6f);
    EXPECT_NEAR((*rigid)[0][2], -1.0f, 1e-6f);
    EXPECT_EQ((*rigid)[3][2], 9.0f);
    EXPECT_NEAR(rigid->determinant(), 1.0f, 1e-5f);
}

TEST(RigidPart, OfAMirrorIsARotation) {
    const std::optional<Mat4f> rigid = rigid_part(scaled(-2, 1, 1));
    ASSERT_TRUE(rigid);
    EXPECT_NEAR(rigid->determinant(), 1.0f, 1e-5f);
}

TEST(RigidPart, NeedsItsAxes) {
    EXPECT_FALSE(rigid_part(scaled(1, 1, 0)));
    EXPECT_FALSE(rigid_part(scaled(1, 0, 1)));
}

}  // namespace
}  // namespace etendue
