#include "compare/comparison_measures.h"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

TEST(FindRegions, AreWhereErrorsDifferMost) {
    std::vector<ImageF> maps(2, ImageF(48, 48, 1));
    maps[1].pixel(20, 30)[0] = 5.0f;
    maps[0].pixel(40, 2)[0] = 7.0f;
    const std::vector<NamedRegion> regions = find_regions(maps, {100, 200, 148, 248});
    ASSERT_EQ(regions.size(), 3u);
    EXPECT_EQ(regions[0].pixels, (PixelRect{140, 200, 148, 208}));
    EXPECT_EQ(regions[1].pixels, (PixelRect{116, 224, 124, 232}));
    EXPECT_TRUE(find_regions(std::span(maps).first(1), {0, 0, 48, 48}).empty()) << "one has none to differ from";
}

TEST(FindRegions, LeaveOutWhatIsNoNumber) {
    std::vector<ImageF> maps(2, ImageF(48, 48, 1));
    for (int block = 0; block < 36; ++block)
        maps[1].pixel(8 * (block % 6), 8 * (block / 6))[0] = block % 3 == 0   ? std::numeric_limits<float>::quiet_NaN()
                                                             : block % 3 == 1 ? std::numeric_limits<float>::infinity()
                                                                              : static_cast<float>(block);
    const std::vector<NamedRegion> regions = find_regions(maps, {0, 0, 48, 48});
    ASSERT_EQ(regions.size(), 3u);
    EXPECT_EQ(regions[0].pixels, (PixelRect{40, 40, 48, 48}));
    EXPECT_EQ(regions[1].pixels, (PixelRect{16, 40, 24, 48}));
}

}  // namespace

}  // namespace etendue::test
