#include "light/opposite_triangles.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

TEST(OppositeTriangles, FaceOppositeWaysAndBelongToEachOther) {
    // Rings of normals, and the opposite of each but for every seventh.
    std::vector<Vec3f> normals;
    std::vector<double> areas;
    for (int i = 0; i < 500; ++i) {
        const float cosine = 1.0f - 2.0f * (static_cast<float>(i) + 0.5f) / 500.0f;
        const float sine = std::sqrt(1.0f - cosine * cosine);
        const float phi = 2.4f * static_cast<float>(i);
        normals.emplace_back(sine * std::cos(phi), cosine, sine * std::sin(phi));
        areas.push_back(1.0 + i % 3);
        if (i % 7 == 0) continue;
        normals.push_back(-normals.back());
        areas.push_back(areas.back());
    }
    const std::vector<std::uint32_t> opposites = pair_opposite_triangles(normals, areas);
    ASSERT_EQ(opposites.size(), normals.size());
    std::size_t alone = 0;
    for (std::uint32_t i = 0; i < opposites.size(); ++i) {
        const std::uint32_t other = opposites[i];
        ASSERT_LT(other, opposites.size());
        EXPECT_EQ(opposites[other], i);
        if (other == i)
            ++alone;
        else
            EXPECT_LT(dot(normals[i], normals[other]), -0.93f) << i;  // cos of 21 degrees
    }
    // No more than the 72 without one, which take others' where they are in time.
    EXPECT_LE(alone, 72u);
}

TEST(OppositeTriangles, LargeOnesFindLargeOnes) {
    const Vec3f up(0, 0, 1);
    const std::vector<Vec3f> normals{up, up, up, -up, -up, -up, up};
    const std::vector<double> areas{1.0, 9.0, 4.0, 4.0, 1.0, 9.0, 0.5};
    EXPECT_EQ(pair_opposite_triangles(normals, areas), (std::vector<std::uint32_t>{4, 5, 3, 2, 0, 1, 6}));
}

TEST(OppositeTriangles, WhatFacesAlongAxesIsFoundWhateverTheSignsOfZerosAre) {
    for (int axis = 0; axis < 3; ++axis) {
        Vec3f one(0.0f);
        one[axis] = 1.0f;
        const std::vector<Vec3f> normals{one, -one};  // with zeros of both signs
        const std::vector<double> areas{1.0, 1.0};
        EXPECT_EQ(pair_opposite_triangles(normals, areas), (std::vector<std::uint32_t>{1, 0}));
    }
}

TEST(OppositeTriangles, EdgesCutAtHalfARightAngleFindEachOtherHoweverTheyAreRounded) {
    const float half = std::sqrt(0.5f);
    const float more = std::nextafter(half, 1.0f);
    for (int axis = 0; axis < 3; ++axis) {
        Vec3f one(0.0f);
        Vec3f other(0.0f);
        one[axis] = more;
        one[(axis + 1) % 3] = half;
        other[axis] = -half;
        other[(axis + 1) % 3] = -more;
        EXPECT_EQ(pair_opposite_triangles(std::vector<Vec3f>{one, other}, std::vector<double>{1.0, 1.0}),
                  (std::vector<std::uint32_t>{1, 0}));
    }
}

TEST(OppositeTriangles, WithoutAreaOrNormalThereIsNone) {
    const Vec3f up(0, 1, 0);
    const Vec3f none(std::numeric_limits<float>::quiet_NaN());
    const std::vector<Vec3f> normals{up, -up, -up, none, Vec3f(0.0f)};
    const std::vector<double> areas{1.0, 0.0, 2.0, 3.0, 1.0};
    EXPECT_EQ(pair_opposite_triangles(normals, areas), (std::vector<std::uint32_t>{2, 1, 0, 3, 4}));
    // Nor where areas differ so much that the larger one's chance would only be noise on the smaller.
    EXPECT_EQ(pair_opposite_triangles(std::vector<Vec3f>{up, -up}, std::vector<double>{1.0, 1e5}),
              (std::vector<std::uint32_t>{0, 1}));
    EXPECT_TRUE(pair_opposite_triangles({}, {}).empty());
}

TEST(OppositeTriangles, AFlatSheetHasNone) {
    const std::vector<Vec3f> normals(1000, normalize(Vec3f(1, 2, 3)));
    const std::vector<double> areas(normals.size(), 1.0);
    const std::vector<std::uint32_t> opposites = pair_opposite_triangles(normals, areas);
    for (std::uint32_t i = 0; i < opposites.size(); ++i) EXPECT_EQ(opposites[i], i);
}

}  // namespace

}  // namespace etendue::test
