#include "picture/sample_ranges.h"

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

using Ranges = std::vector<SampleRange>;

TEST(SampleRanges, BordersAreThoseOfPassesWhereThereAreEnough) {
    EXPECT_EQ(split_samples(64, 2), (Ranges{{0, 32}, {32, 64}}));
    EXPECT_EQ(split_samples(100, 3), (Ranges{{0, 32}, {32, 64}, {64, 100}}));
    EXPECT_EQ(split_samples(48, 3), (Ranges{{0, 16}, {16, 32}, {32, 48}}));
    EXPECT_EQ(split_samples(33, 3), (Ranges{{0, 16}, {16, 32}, {32, 33}}));
    EXPECT_EQ(split_samples(32, 3), (Ranges{{0, 10}, {10, 21}, {21, 32}}));
    EXPECT_EQ(split_samples(2, 3), (Ranges{{0, 1}, {1, 2}}));
    EXPECT_EQ(split_samples(7, 1), (Ranges{{0, 7}}));
}

TEST(SampleRanges, CoverAllSamplesOnceAndEvenly) {
    for (std::uint32_t spp = 1; spp < 300; spp += 7)
        for (std::uint32_t count = 1; count < 40; ++count) {
            const Ranges ranges = split_samples(spp, count);
            EXPECT_LE(ranges.size(), count);
            std::uint32_t next = 0;
            for (const SampleRange& range : ranges) {
                EXPECT_EQ(range.begin, next);
                EXPECT_GT(range.end, range.begin);
                next = range.end;
            }
            EXPECT_EQ(next, spp);
        }
    const std::uint32_t most = 1u << 24u;
    EXPECT_EQ(split_samples(most, 1000).back().end, most);
    EXPECT_EQ(split_samples(most, 1000).size(), 1000u);
}

}  // namespace

}  // namespace etendue::test
