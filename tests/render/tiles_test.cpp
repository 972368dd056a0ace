#include "render/tiles.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

TEST(Tiles, CoverTheWindowExactlyOnce) {
    const PixelRect windows[] = {{0, 0, 1, 1},     {0, 0, 32, 32},   {0, 0, 33, 31},     {0, 0, 640, 360}, {5, 7, 6, 8},
                                 {31, 31, 33, 33}, {32, 64, 64, 96}, {17, 40, 301, 111}, {-8, -40, 70, 33}};
    for (const PixelRect& window : windows) {
        std::vector<int> covered(window.area(), 0);
        for (const PixelRect& tile : make_tiles(window)) {
            ASSERT_GT(tile.width(), 0);
            ASSERT_GT(tile.height(), 0);
            for (int y = tile.y0; y < tile.y1; ++y)
                for (int x = tile.x0; x < tile.x1; ++x) {
                    ASSERT_TRUE(x >= window.x0 && x < window.x1 && y >= window.y0 && y < window.y1);
                    ++covered[static_cast<std::size_t>((y - window.y0) * window.width() + x - window.x0)];
                }
        }
        EXPECT_TRUE(std::all_of(covered.begin(), covered.end(), [](int n) { return n == 1; }));
    }
}

TEST(Tiles, LieOnTheGridOfTheFullImage) {
    const auto column = [](int pixel) { return std::floor(static_cast<double>(pixel) / kTileSize); };
    for (const PixelRect& window : {PixelRect{17, 40, 301, 111}, PixelRect{-40, -8, 64, 40}})
        for (const PixelRect& tile : make_tiles(window)) {
            EXPECT_EQ(column(tile.x0), column(tile.x1 - 1));
            EXPECT_EQ(column(tile.y0), column(tile.y1 - 1));
        }
}

TEST(Tiles, GoRowByRow) {
    const auto less = [](const PixelRect& a, const PixelRect& b) { return a.y0 != b.y0 ? a.y0 < b.y0 : a.x0 < b.x0; };
    const std::vector<PixelRect> tiles = make_tiles({0, 0, 320, 320});
    EXPECT_TRUE(std::is_sorted(tiles.begin(), tiles.end(), less));
}

TEST(MakeOrder, TheSeedShufflesAllNumbers) {
    const std::vector<std::size_t> in_order = make_order(100, 0);
    EXPECT_TRUE(std::is_sorted(in_order.begin(), in_order.end()));
    std::vector<std::size_t> shuffled = make_order(100, 3);
    EXPECT_NE(shuffled, in_order);
    EXPECT_NE(shuffled, make_order(100, 4));
    std::sort(shuffled.begin(), shuffled.end());
    EXPECT_EQ(shuffled, in_order);
}

TEST(LargestSplatGroup, HoldsAMillionSamplesButAtLeastOneTile) {
    EXPECT_EQ(largest_splat_group(1), 1024u);
    EXPECT_EQ(largest_splat_group(16), 64u);
    EXPECT_EQ(largest_splat_group(1u << 20), 1u);
}

TEST(PassSize, GrowsToSixteenAndStopsAtTheTotal) {
    const auto sequence = [](std::uint32_t total) {
        std::vector<std::uint32_t> sizes;
        for (std::uint32_t done = 0; done < total; done += sizes.back()) sizes.push_back(pass_size(done, total));
        return sizes;
    };
    EXPECT_EQ(sequence(1), (std::vector<std::uint32_t>{1}));
    EXPECT_EQ(sequence(50), (std::vector<std::uint32_t>{1, 1, 2, 4, 8, 16, 16, 2}));
    EXPECT_EQ(sequence(7), (std::vector<std::uint32_t>{1, 1, 2, 3}));
}

TEST(IsOddPass, IsTrueForEveryOtherPass) {
    bool before = is_odd_pass(0);
    for (std::uint32_t first = pass_size(0, 1000); first < 1000; first += pass_size(first, 1000)) {
        EXPECT_NE(is_odd_pass(first), before) << first;
        before = is_odd_pass(first);
    }
}

TEST(IsOddPass, IsTheSameInAllOfAPass) {
    for (std::uint32_t first = 0; first < 100; first += pass_size(first, 100))
        for (std::uint32_t i = 0; i < pass_size(first, 100); ++i)
            EXPECT_EQ(is_odd_pass(first + i), is_odd_pass(first)) << first + i;
}

TEST(FitPass, TakesWhatFitsIntoTheTimeLeft) {
    EXPECT_EQ(fit_pass(1, 0, 0.0, 1.0), 1u) << "nothing is known about the pace yet";
    EXPECT_EQ(fit_pass(16, 16, 1.0, 10.0), 16u);
    EXPECT_EQ(fit_pass(16, 16, 1.0, 1.5), 8u);
    EXPECT_EQ(fit_pass(16, 16, 1.0, 1.001), 1u) << "a pass that is begun has a sample";
}

}  // namespace

}  // namespace etendue::test
