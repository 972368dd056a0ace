#include "core/bounds.h"

#include <gtest/gtest.h>

namespace etendue {

namespace {

TEST(Bounds, StartsEmptyWithDefinedSizeAndCenter) {
    const Bounds bounds;
    EXPECT_TRUE(bounds.empty());
    EXPECT_EQ(bounds.size(), Vec3f(0.0f));
    EXPECT_EQ(bounds.center(), Vec3f(0.0f));
}

TEST(Bounds, HoldsEveryPointItWasGiven) {
    Bounds bounds;
    bounds.extend({1.0f, -2.0f, 3.0f});
    EXPECT_FALSE(bounds.empty()) << "one point is a box without volume";
    EXPECT_EQ(bounds.size(), Vec3f(0.0f));
    bounds.extend({-1.0f, 4.0f, 3.0f});
    EXPECT_EQ(bounds.min, Vec3f(-1.0f, -2.0f, 3.0f));
    EXPECT_EQ(bounds.max, Vec3f(1.0f, 4.0f, 3.0f));
    EXPECT_EQ(bounds.center(), Vec3f(0.0f, 1.0f, 3.0f));
    EXPECT_EQ(bounds.size(), Vec3f(2.0f, 6.0f, 0.0f));
}

TEST(Bounds, AnEmptyBoxAddsNothing) {
    Bounds bounds;
    bounds.extend({1.0f, 2.0f, 3.0f});
    bounds.extend(Bounds{});
    EXPECT_EQ(bounds.min, bounds.max);
    Bounds other;
    other.extend(bounds);
    EXPECT_EQ(other.min, Vec3f(1.0f, 2.0f, 3.0f));
}

}  // namespace

}  // namespace etendue
