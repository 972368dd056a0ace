#include "core/pixel_rect.h"

#include <gtest/gtest.h>

namespace etendue {
namespace {

TEST(PixelRect, IntersectionIsWhatLiesInBoth) {
    const PixelRect a{2, 3, 10, 8};
    EXPECT_EQ(intersection(a, {5, 0, 20, 5}), (PixelRect{5, 3, 10, 5}));
    EXPECT_EQ(intersection(a, a), a);
    EXPECT_FALSE(intersection(a, {9, 7, 20, 20}).empty());
    EXPECT_TRUE(intersection(a, {10, 3, 20, 8}).empty()) << "the last column is not part of it";
    EXPECT_TRUE(intersection(a, {0, 0, 2, 3}).empty());
}

TEST(PixelRect, KeepsItsSizeWhenItIsMoved) {
    const PixelRect moved = moved_to({2, 3, 10, 8}, -1, 0);
    EXPECT_EQ(moved, (PixelRect{-1, 0, 7, 5}));
    EXPECT_EQ(moved.area(), 40u);
    EXPECT_TRUE(PixelRect{}.empty());
}

}  // namespace
}  // namespace etendue
