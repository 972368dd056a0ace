#include "sampling/sampler.h"

#include "support/chi2.h"

#include <array>
#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr SampleSequence kSequences[] = {SampleSequence::Sobol, SampleSequence::Random};

TEST(Sampler, DependsOnTheKeyAndNothingElse) {
    for (const SampleSequence sequence : kSequences) {
        const SampleKey key{make_pixel_seed(7, 100, 200), 13};
        const Vec2f first = sample_2d(sequence, key, 5);
        for (std::uint32_t i = 0; i < 100; ++i) (void)sample_2d(sequence, {i, i}, i);
        EXPECT_EQ(sample_2d(sequence, key, 5), first);
        EXPECT_NE(sample_2d(sequence, {make_pixel_seed(8, 100, 200), 13}, 5), first) << "seed";
        EXPECT_NE(sample_2d(sequence, {make_pixel_seed(7, 101, 200), 13}, 5), first) << "x";
        EXPECT_NE(sample_2d(sequence, {make_pixel_seed(7, 100, 201), 13}, 5), first) << "y";
        EXPECT_NE(sample_2d(sequence, {key.pixel_seed, 14}, 5), first) << "index";
        EXPECT_NE(sample_2d(sequence, key, 6), first) << "dimension";
    }
}

// Stored references depend on these numbers: a change of the sequence is a change of every image.
TEST(Sampler, KeepsItsNumbers) {
    const SampleKey key{make_pixel_seed(1, 2, 3), 4};
    EXPECT_EQ(key.pixel_seed, 2233009001u);
    EXPECT_NE(make_pixel_seed(1, 2, 3), make_pixel_seed(1, 3, 2));
    EXPECT_NE(make_pixel_seed(0, 0, 0), 0u);
    EXPECT_EQ(sample_bits(key, 5), 2240623223u);
    EXPECT_EQ(sample_2d(SampleSequence::Random, key, 5), Vec2f(0x1.478a3cp-1f, 0x1.b0bafp-2f));
    EXPECT_EQ(sample_2d(SampleSequence::Sobol, key, 5), Vec2f(0x1.6d7778p-2f, 0x1.93c038p-3f));
    EXPECT_NE(sample_bits(key, 5), sample_bits(key, 6));
}

TEST(Sampler, ManyAtOnceAreTheSameNumbers) {
    std::vector<std::uint32_t> seeds(37);
    std::vector<std::uint32_t> indices(37);
    for (std::uint32_t i = 0; i < 37; ++i) {
        seeds[i] = hash_u32(i);
        indices[i] = i % 2 == 0 ? i * 11 : hash_u32(i + 37);
    }
    for (const SampleSequence sequence : kSequences) {
        std::vector<float> x(37);
        std::vector<float> y(37);
        sample_2d(sequence, seeds, indices, 9, x, y);
        for (std::size_t i = 0; i < 37; ++i)
            EXPECT_EQ(Vec2f(x[i], y[i]), sample_2d(sequence, {seeds[i], indices[i]}, 9));
    }
}

TEST(Sampler, PixelSeedsOfATileDiffer) {
    std::set<std::uint32_t> seeds;
    for (std::uint32_t seed = 0; seed < 4; ++seed)
        for (std::uint32_t y = 0; y < 64; ++y)
            for (std::uint32_t x = 0; x < 64; ++x) seeds.insert(make_pixel_seed(seed, x, y));
    // Of 16384 random words about 0.03 pairs agree.
    EXPECT_GE(seeds.size(), 4u * 64u * 64u - 1u);
}

/// A histogram over a grid of cells must be that of independent uniform numbers.
template <typename Pair>
double independence_p_value(const Pair& pair, int count) {
    constexpr std::size_t kCells = 16;
    std::vector<double> observed(kCells * kCells);
    for (int i = 0; i < count; ++i) {
        const Vec2f p = pair(static_cast<std::uint32_t>(i));
        observed[static_cast<std::size_t>(p.y * kCells) * kCells + static_cast<std::size_t>(p.x * kCells)] += 1.0;
    }
    return chi2_counts(observed, std::vector<double>(kCells * kCells, static_cast<double>(count) / (kCells * kCells)))
        .p_value;
}

constexpr int kCount = 20'000;
constexpr std::size_t kIndependenceTests = 2 * 8 * 3 + 2 * 5;

// What a path uses together: numbers of two dimensions of one sample, over pixels, for the first and a later sample.
TEST(Sampler, DimensionsAreIndependentOverPixels) {
    const double level = sidak_level(kFamilyLevel, kIndependenceTests);
    for (const SampleSequence sequence : kSequences)
        for (const std::uint32_t dimension : {0u, 1u, 2u, 7u, 8u, 31u, 64u, 1000u})
            for (const std::uint32_t index : {0u, 1u, 777u}) {
                const auto pair = [&](std::uint32_t i) {
                    const SampleKey key{make_pixel_seed(3, i % 200, i / 200), index};
                    return Vec2f(sample_2d(sequence, key, dimension).x, sample_2d(sequence, key, dimension + 1).x);
                };
                EXPECT_GE(independence_p_value(pair, kCount), level) << dimension << " " << index;
            }
}

TEST(Sampler, NeighbouringPixelsSeedsAndSamplesAreIndependent) {
    const double level = sidak_level(kFamilyLevel, kIndependenceTests);
    for (const SampleSequence sequence : kSequences) {
        const auto at = [&](std::uint32_t seed, std::uint32_t x, std::uint32_t y, std::uint32_t index) {
            return sample_2d(sequence, {make_pixel_seed(seed, x, y), index}, 2);
        };
        EXPECT_GE(independence_p_value([&](auto i) { return at(3, i % 200, i / 200, 0); }, kCount), level)
            << "x and y of one pair";
        EXPECT_GE(independence_p_value(
                      [&](auto i) {
                          const std::uint32_t x = 2 * (i % 200);
                          return Vec2f(at(3, x, i / 200, 0).x, at(3, x + 1, i / 200, 0).x);
                      },
                      kCount),
                  level)
            << "a pixel and its right neighbour";
        EXPECT_GE(independence_p_value(
                      [&](auto i) {
                          const std::uint32_t y = 2 * (i / 200);
                          return Vec2f(at(3, i % 200, y, 0).y, at(3, i % 200, y + 1, 0).y);
                      },
                      kCount),
                  level)
            << "a pixel and the one below";
        EXPECT_GE(
            independence_p_value(
                [&](auto i) { return Vec2f(at(3, i % 200, i / 200, 5).x, at(4, i % 200, i / 200, 5).x); }, kCount),
            level)
            << "two seeds";
        EXPECT_GE(independence_p_value(
                      [&](auto i) {
                          const SampleKey key{make_pixel_seed(3, i % 200, i / 200), 2};
                          return Vec2f(sample_2d(sequence, key, 4).x, to_unit_float(sample_bits(key, 4)));
                      },
                      kCount),
                  level)
            << "sample_2d and sample_bits";
    }
}

// Padding pairs must not line up within a pixel either: over the samples of one pixel two dimensions show no
// correlation.
TEST(Sampler, DimensionsAreUncorrelatedWithinAPixel) {
    constexpr std::uint32_t kSamples = 256;
    constexpr std::uint32_t kPixels = 64;
    double largest = 0.0;
    double mean_square = 0.0;
    for (std::uint32_t pixel = 0; pixel < kPixels; ++pixel) {
        double product = 0.0;
        for (std::uint32_t i = 0; i < kSamples; ++i) {
            const SampleKey key{make_pixel_seed(1, pixel, 0), i};
            product += (static_cast<double>(sample_2d(SampleSequence::Sobol, key, 0).x) - 0.5) *
                       (static_cast<double>(sample_2d(SampleSequence::Sobol, key, 1).x) - 0.5);
        }
        const double correlation = 12.0 * product / kSamples;
        largest = std::max(largest, std::abs(correlation));
        mean_square += correlation * correlation / kPixels;
    }
    // Independent numbers have the variance 1 / n.
    EXPECT_LT(largest, 4.5 / std::sqrt(static_cast<double>(kSamples)));
    EXPECT_NEAR(mean_square * kSamples, 1.0, 1.0);
}

}  // namespace

}  // namespace etendue::test
