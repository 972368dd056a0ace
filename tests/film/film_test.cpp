#include "film/film.h"

#include "support/random.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

TileBuffer filled(const PixelRect& rect, std::uint32_t seed, int samples) {
    TileBuffer tile;
    tile.reset(rect);
    Random random(seed);
    for (std::size_t i = 0; i < rect.area(); ++i)
        for (int s = 0; s < samples; ++s) {
            const Vec2f rg = random.next_2d();
            tile.pixel(i).add({rg.x, rg.y * 1e4f, random.next()}, random.next(), 1.0f);
        }
    return tile;
}

TEST(Film, ResolvesToMeans) {
    Film film(2, 1, {0, 0, 2, 1});
    TileBuffer tile;
    tile.reset({0, 0, 2, 1});
    tile.pixel(0).add({1.0f, 2.0f, 3.0f}, 1.0f, 1.0f);
    tile.pixel(0).add({3.0f, 4.0f, -1.0f}, 0.0f, 1.0f);
    film.add(tile);
    EXPECT_EQ(film.resolve(), (std::vector<float>{2.0f, 3.0f, 1.0f, 0.5f, 0.0f, 0.0f, 0.0f, 0.0f}));
    EXPECT_EQ(film.sample_count(), 2u);
}

// Negative filter weights: what is even stays even, whatever weights came up, and few samples do not blow up.
TEST(Film, DividesByTheFilterWeights) {
    Film film(2, 1, {0, 0, 2, 1});
    TileBuffer tile;
    tile.reset({0, 0, 2, 1});
    for (const float weight : {1.2f, 1.2f, -1.2f, 1.2f}) tile.pixel(0).add(Rgb(5.0f), 1.0f, weight);
    for (const float weight : {1.2f, -1.2f}) tile.pixel(1).add(Rgb(5.0f), 1.0f, weight);
    film.add(tile);
    const std::vector<float> image = film.resolve();
    EXPECT_FLOAT_EQ(image[0], 5.0f);
    EXPECT_FLOAT_EQ(image[3], 1.0f);
    EXPECT_FLOAT_EQ(image[4], 0.0f);
}

// Of the mean of two samples 1 and 4 the variance is estimated by half the square of their distance, over two.
TEST(Film, VarianceIsThatOfTheMeanOfTwoKnownSamples) {
    const LayerLayout layout{.has_moments = true};
    Film film(1, 1, {0, 0, 1, 1}, {0, 0, 1, 1}, layout);
    TileBuffer tile;
    tile.reset({0, 0, 1, 1}, layout);
    for (const Rgb& sample : {Rgb(1.0f, 2.0f, 5.0f), Rgb(4.0f, 2.0f, 3.0f)}) {
        tile.pixel(0).add(sample, 1.0f, 1.0f);
        tile.layers().add_moments(0, sample, 1.0);
    }
    film.add(tile);
    const std::vector<float> variance = film.resolve_variance();
    ASSERT_EQ(variance.size(), 3u);
    EXPECT_FLOAT_EQ(variance[0], 2.25f);
    EXPECT_FLOAT_EQ(variance[1], 0.0f);
    EXPECT_FLOAT_EQ(variance[2], 1.0f);
}

// Of a filter with negative parts the mean is a ratio. Here it is 1, and the squares of what is weighted are those of
// 0, 1.2, 2.4 and -3.6: 20.16 over the square of the weight, 2.4, and three quarters.
TEST(Film, VarianceIsThatOfARatioWhereWeightsAreNegative) {
    const LayerLayout layout{.has_moments = true};
    Film film(1, 1, {0, 0, 1, 1}, {0, 0, 1, 1}, layout);
    TileBuffer tile;
    tile.reset({0, 0, 1, 1}, layout);
    for (const float value : {1.0f, 2.0f, 3.0f, 4.0f}) {
        const float weight = value < 4.0f ? 1.2f : -1.2f;
        tile.pixel(0).add(Rgb(value), 1.0f, weight);
        tile.layers().add_moments(0, Rgb(value), static_cast<double>(weight));
    }
    film.add(tile);
    EXPECT_FLOAT_EQ(film.resolve()[0], 1.0f);
    EXPECT_NEAR(film.resolve_variance()[0], 20.16f / (2.4f * 2.4f) / 0.75f, 1e-5f);
}

// Two light paths, one of which leaves 3: the mean is 1.5, and the sum of squares less that of the mean is 4.5, over
// the square of the number of paths.
TEST(Film, MomentsGrowAsIfAllWereOneSample) {
    const LayerLayout layout{.has_moments = true};
    LayerBuffer at_once(layout, 1);
    LayerBuffer bit_by_bit(layout, 1);
    const Rgb radiance(1.0f, 2.0f, 0.5f);
    const Rgb light(4.0f, 0.25f, 8.0f);
    at_once.add_moments(0, radiance + light, 1.0);
    bit_by_bit.add_moments(0, radiance, 1.0);
    bit_by_bit.grow_moments(0, radiance, light);
    for (std::size_t i = 0; i < LayerLayout::kMomentSums; ++i)
        EXPECT_NEAR(at_once.all_sums()[i], bit_by_bit.all_sums()[i], 1e-6) << i;
}

TEST(Film, VarianceOfSplatsIsThatOfTheSumOverKnownLightPaths) {
    const LayerLayout layout{.has_moments = true};
    Film film(1, 1, {0, 0, 1, 1}, {0, 0, 1, 1}, layout);
    const std::vector<std::vector<Splat>> lists{{{.position = {0.5f, 0.5f}, .value = {3.0f, 0.0f, 6.0f}}}};
    film.add_splats(lists, 2, PixelFilter(FilterShape::Box), ThreadPool(1));
    const std::vector<float> variance = film.resolve_variance();
    ASSERT_EQ(variance.size(), 3u);
    EXPECT_FLOAT_EQ(variance[0], 4.5f / 4.0f);
    EXPECT_FLOAT_EQ(variance[1], 0.0f);
    EXPECT_FLOAT_EQ(variance[2], 18.0f / 4.0f);
}

TEST(Film, WindowsPlaceTilesByTheFullImagesCoordinates) {
    const PixelRect window{10, 20, 14, 23};
    Film film(100, 50, window);
    EXPECT_EQ(film.full_width(), 100);
    EXPECT_EQ(film.full_height(), 50);
    EXPECT_EQ(film.window(), window);
    TileBuffer tile;
    tile.reset({12, 21, 14, 23});
    for (std::size_t i = 0; i < 4; ++i) tile.pixel(i).add(Rgb(static_cast<float>(i + 1)), 1.0f, 1.0f);
    film.add(tile);
    const std::vector<float> image = film.resolve();
    ASSERT_EQ(image.size(), 4u * 3u * 4u);
    const auto red = [&](int x, int y) { return image[static_cast<std::size_t>((y - 20) * 4 + x - 10) * 4]; };
    EXPECT_EQ(red(12, 21), 1.0f);
    EXPECT_EQ(red(13, 21), 2.0f);
    EXPECT_EQ(red(12, 22), 3.0f);
    EXPECT_EQ(red(13, 22), 4.0f);
    EXPECT_EQ(red(11, 21), 0.0f);
    EXPECT_EQ(red(12, 20), 0.0f);
}

TEST(Film, TheOrderOfTilesDoesNotChangeABit) {
    std::vector<TileBuffer> tiles;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 5; ++x)
            tiles.push_back(filled({x * 8, y * 8, x * 8 + 8, y * 8 + 8}, static_cast<std::uint32_t>(x + 5 * y), 3));
    const auto render = [&] {
        Film film(40, 32, {0, 0, 40, 32});
        for (int pass = 0; pass < 2; ++pass)
            for (const TileBuffer& tile : tiles) film.add(tile);
        return film.resolve();
    };
    const std::vector<float> in_order = render();
    std::reverse(tiles.begin(), tiles.end());
    std::swap(tiles[3], tiles[11]);
    const std::vector<float> other = render();
    ASSERT_EQ(in_order.size(), other.size());
    EXPECT_EQ(std::memcmp(in_order.data(), other.data(), in_order.size() * sizeof(float)), 0);
}

TEST(Film, ManySmallSamplesAreNotLost) {
    // In single precision the sum of 2^25 ones stops at 2^24.
    Film film(1, 1, {0, 0, 1, 1});
    TileBuffer tile;
    for (int pass = 0; pass < 2; ++pass) {
        tile.reset({0, 0, 1, 1});
        for (int i = 0; i < (1 << 24) + 5; ++i) tile.pixel(0).add(Rgb(1.0f), 1.0f, 1.0f);
        film.add(tile);
    }
    EXPECT_EQ(film.resolve(), (std::vector<float>{1.0f, 1.0f, 1.0f, 1.0f}));
    EXPECT_EQ(film.sample_count(), 2u * ((1u << 24) + 5u));
}

// Splats of which many lie where the filter of a pixel ends, which is where bands of the image end for some numbers of
// threads.
TEST(Film, DepthsOfSplatsAreTheSameForEveryNumberOfThreads) {
    constexpr int kSide = 24;
    const PixelFilter filter(FilterShape::BlackmanHarris);
    Random random(4);
    std::vector<std::vector<Splat>> lists(3);
    for (std::vector<Splat>& list : lists)
        for (int i = 0; i < 500; ++i) {
            const float half_rows = std::floor(random.next() * 2.0f * (kSide + 4));
            list.push_back({.position = {random.next() * kSide, 0.5f * half_rows - 2.0f},
                            .value = {random.next(), random.next(), random.next()},
                            .depth = 1.0f + 50.0f * random.next()});
        }
    const PixelRect window{0, 0, kSide, kSide};
    const auto bins_of = [&](int threads) {
        Film film(kSide, kSide, window, window, {.is_deep = true});
        film.add_splats(lists, 1000, filter, ThreadPool(threads));
        std::vector<double> numbers;
        for (std::size_t p = 0; p < window.area(); ++p)
            for (const DeepBin& bin : film.layers().deep().bins(p))
                for (const double number : {static_cast<double>(bin.front), static_cast<double>(bin.back), bin.splat_r,
                                            bin.splat_g, bin.splat_b})
                    numbers.push_back(number);
        return numbers;
    };
    const std::vector<double> one = bins_of(1);
    EXPECT_GT(one.size(), 5u * 500);
    for (const int threads : {2, 3, 4, 5, 7}) EXPECT_EQ(bins_of(threads), one) << threads;
}

TEST(TileBuffer, ResetForgets) {
    TileBuffer tile = filled({0, 0, 4, 4}, 1, 2);
    tile.reset({8, 8, 10, 10});
    EXPECT_EQ(tile.rect(), (PixelRect{8, 8, 10, 10}));
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(tile.pixel(i).samples, 0u);
}

}  // namespace

}  // namespace etendue::test
