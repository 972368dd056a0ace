#include "film/mattes.h"

#include "film/film.h"
#include "film/wave_hits.h"
#include "support/random.h"

#include <bit>
#include <map>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

std::vector<std::pair<std::uint32_t, double>> pairs(const std::vector<MatteShare>& shares) {
    std::vector<std::pair<std::uint32_t, double>> result;
    result.reserve(shares.size());
    for (const MatteShare& share : shares) result.emplace_back(share.id, share.weight);
    return result;
}

using Pairs = std::vector<std::pair<std::uint32_t, double>>;

TEST(MatteBuffer, SumsWeightsAndRanksThem) {
    MatteBuffer mattes;
    mattes.reset(2, 4, 3);
    mattes.add(1, 0, 7, 1.0);
    mattes.add(1, 0, 5, 2.0);
    mattes.add(1, 0, 7, 0.5);
    mattes.add(1, 0, MatteBuffer::kNoId, 9.0);
    mattes.add(1, 1, 7, 4.0);
    EXPECT_EQ(pairs(mattes.ranked(1, 0)), (Pairs{{5, 2.0}, {7, 1.5}}));
    EXPECT_EQ(pairs(mattes.ranked(1, 1)), (Pairs{{7, 4.0}}));
    EXPECT_TRUE(mattes.ranked(0, 0).empty());
    mattes.add(1, 0, 7, 0.5);
    EXPECT_EQ(pairs(mattes.ranked(1, 0)), (Pairs{{5, 2.0}, {7, 2.0}})) << "of equals the smaller id first";
}

TEST(MatteBuffer, LosesTheLightestAndKeepsTheOthersRight) {
    MatteBuffer mattes;
    mattes.reset(1, 3, 1);
    for (const std::uint32_t id : {1u, 2u, 3u}) mattes.add(0, 0, id, id);
    mattes.add(0, 0, 4, 0.5);  // lighter than all
    EXPECT_EQ(pairs(mattes.ranked(0, 0)), (Pairs{{3, 3.0}, {2, 2.0}, {1, 1.0}}));
    mattes.add(0, 0, 5, 1.5);
    EXPECT_EQ(pairs(mattes.ranked(0, 0)), (Pairs{{3, 3.0}, {2, 2.0}, {5, 1.5}}));
    mattes.add(0, 0, 3, 1.0);
    EXPECT_EQ(pairs(mattes.ranked(0, 0)), (Pairs{{3, 4.0}, {2, 2.0}, {5, 1.5}}));
}

// Where there are no more ids than slots, sums of sums are the sums of all.
TEST(MatteBuffer, PartsAddUp) {
    Random random(3);
    MatteBuffer whole;
    MatteBuffer sum;
    MatteBuffer part;
    whole.reset(2, 8, 2);
    sum.reset(2, 8, 2);
    for (int p = 0; p < 5; ++p) {
        part.reset(2, 8, 2);
        for (int i = 0; i < 50; ++i) {
            const Vec2f u = random.next_2d();
            const std::size_t pixel = u.x < 0.5f ? 0 : 1;
            const auto id = static_cast<std::uint32_t>(1.0f + u.y * 8.0f);
            for (MatteBuffer* buffer : {&whole, &part}) buffer->add(pixel, i % 2 == 0 ? 0 : 1, id, 0.25);
        }
        for (const std::size_t pixel : {std::size_t{0}, std::size_t{1}}) sum.add(pixel, part, pixel);
    }
    for (const std::size_t pixel : {std::size_t{0}, std::size_t{1}})
        for (const std::size_t matte : {std::size_t{0}, std::size_t{1}})
            EXPECT_EQ(pairs(sum.ranked(pixel, matte)), pairs(whole.ranked(pixel, matte)));
}

TEST(MatteBuffer, LeavesOutWhatIsNegative) {
    MatteBuffer mattes;
    mattes.reset(1, 4, 1);
    mattes.add(0, 0, 1, -0.5);
    mattes.add(0, 0, 2, 1.5);
    EXPECT_EQ(pairs(mattes.ranked(0, 0)), (Pairs{{2, 1.5}}));
    mattes.add(0, 0, 1, 1.0);
    EXPECT_EQ(pairs(mattes.ranked(0, 0)), (Pairs{{2, 1.5}, {1, 0.5}}));
}

// Pixels may have different numbers of samples: coverage is of the pixel's own weight.
TEST(Film, MattesAreSharesOfThePixelsOwnWeight) {
    LayerLayout layout;
    layout.mattes = 1;
    layout.matte_slots = 4;
    Film film(2, 1, {0, 0, 2, 1}, {0, 0, 2, 1}, layout);
    TileBuffer tile;
    for (int pass = 0; pass < 2; ++pass) {
        tile.reset({0, 0, 2, 1}, layout);
        const int samples = pass == 0 ? 4 : 12;  // of the second pixel only
        for (int s = 0; s < samples; ++s) {
            if (pass == 0) tile.pixel(0).add(Rgb(1.0f), 1.0f, 1.25f);
            tile.pixel(1).add(Rgb(1.0f), 1.0f, 1.25f);
            if (pass == 0 && s < 3) tile.layers().mattes().add(0, 0, 0x3f800000u, 1.25);
            if (s < 4) tile.layers().mattes().add(1, 0, 0x40000000u, 1.25);
            if (s == 5) tile.layers().mattes().add(1, 0, 0x40400000u, 1.25);
        }
        film.add(tile);
    }
    EXPECT_EQ(film.resolve_matte(0, 2), (std::vector<float>{1.0f, 0.75f, 0.0f, 0.0f, 2.0f, 0.5f, 3.0f, 0.0625f}));
    EXPECT_EQ(film.resolve_matte(0, 1), (std::vector<float>{1.0f, 0.75f, 2.0f, 0.5f}));
}

// A sample of a filter with negative parts counts for its coverage as much as for its alpha.
TEST(WaveHits, MattesAndNumbersHaveTheFiltersWeight) {
    const LayerLayout layout{.values = 1, .mattes = 1, .matte_slots = 4};
    WaveHits hits;
    hits.reset(layout, 1, 2);
    for (const std::size_t sample : {std::size_t{0}, std::size_t{1}}) {
        hits.set_distance(sample, 1.0f);
        hits.values(sample)[0] = 3.0f;
        hits.ids(sample)[0] = 7;
    }
    LayerBuffer layers(layout, 1);
    hits.add_to(layers, 0, 0, 1.5);
    hits.add_to(layers, 0, 1, -0.25);
    EXPECT_EQ(pairs(layers.mattes().ranked(0, 0)), (Pairs{{7, 1.25}}));
    EXPECT_EQ(layers.sums(0)[layout.value_sums()], 3.75);
}

}  // namespace

}  // namespace etendue::test
