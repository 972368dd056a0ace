#include "core/vec.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace etendue {

namespace {

// Column-major memory of a column-vector matrix, as glTF writes it: scale by (2, 3, 4), turn about z by 90 degrees,
// move.
Mat4f gltf_matrix() {
    Mat4f m;
    const float memory[16] = {0, 2, 0, 0, -3, 0, 0, 0, 0, 0, 4, 0, 10, 20, 30, 1};
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) m[row][column] = memory[4 * row + column];
    return m;
}

TEST(Vec, TransformsPointsAndDirectionsAsGltfMeans) {
    EXPECT_EQ(transform_point(gltf_matrix(), {1.0f, 0.0f, 0.0f}), Vec3f(10.0f, 22.0f, 30.0f));
    EXPECT_EQ(transform_point(gltf_matrix(), {0.0f, 1.0f, 1.0f}), Vec3f(7.0f, 20.0f, 34.0f));
    EXPECT_EQ(transform_vector(gltf_matrix(), {1.0f, 0.0f, 0.0f}), Vec3f(0.0f, 2.0f, 0.0f));
}

TEST(Vec, NormalsStayPerpendicularUnderUnevenScale) {
    const Mat4f m = gltf_matrix();
    const Vec3f tangent = normalize({1.0f, 1.0f, 0.5f});
    const Vec3f other = normalize({-0.3f, 0.2f, 1.0f});
    const Vec3f normal = cross(tangent, other);
    const Vec3f transformed = transform_normal(m.inverse(), normal);
    EXPECT_NEAR(dot(transformed, transform_vector(m, tangent)), 0.0f, 1e-5f);
    EXPECT_NEAR(dot(transformed, transform_vector(m, other)), 0.0f, 1e-5f);
    EXPECT_GT(length(transformed), 0.0f);
}

TEST(Vec, ProductsAndLengths) {
    const Vec3f a{1.0f, 2.0f, 3.0f};
    const Vec3f b{-2.0f, 0.5f, 4.0f};
    EXPECT_EQ(dot(a, b), 11.0f);
    EXPECT_EQ(abs_dot(a, -b), 11.0f);
    EXPECT_EQ(cross({1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}), Vec3f(0.0f, 0.0f, 1.0f));
    EXPECT_EQ(length_squared(a), 14.0f);
    EXPECT_NEAR(length(normalize(b)), 1.0f, 1e-6f);
}

TEST(Vec, FindsWhatIsNotFinite) {
    EXPECT_TRUE(is_finite(Vec3f(1.0f, -2.0f, 3e38f)));
    EXPECT_FALSE(is_finite(Vec3f(std::numeric_limits<float>::infinity(), 0.0f, 0.0f)));
    EXPECT_FALSE(is_finite(Vec3f(0.0f, 0.0f, std::nanf(""))));
}

// Squares of such areas are beyond single precision.
TEST(TriangleNormal, HoldsForTinyLargeAndThinTriangles) {
    for (const float size : {1e-15f, 1e-3f, 1.0f, 1e15f})
        for (const float thin : {1.0f, 1e-9f}) {
            const Vec3f n = triangle_normal({size, 0, 0}, {0, 0.6f * size * thin, 0.8f * size * thin});
            EXPECT_LT(length(n - Vec3f(0.0f, -0.8f, 0.6f)), 1e-6f) << size << " " << thin;
        }
}

}  // namespace

}  // namespace etendue
