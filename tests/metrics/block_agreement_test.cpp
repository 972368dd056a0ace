#include "metrics/block_agreement.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace etendue {
namespace {

/// A grey image with the same mean and variance everywhere.
ImageEstimate constant_estimate(int width, int height, float mean, float variance) {
    ImageEstimate e{ImageF(width, height, 1), ImageF(width, height, 1)};
    e.mean.pixels.assign(e.mean.pixels.size(), mean);
    e.variance.pixels.assign(e.variance.pixels.size(), variance);
    return e;
}

/// Renders of an image that is 1 everywhere but for `extra` in the 8 × 8 pixels at the top left, with noise.
ImageEstimate noisy_estimate(std::uint32_t seed, double extra) {
    std::mt19937 generator(seed);
    std::exponential_distribution<double> noise(1.0);  // mean 1, as skewed as radiance is
    std::vector<ImageF> renders(4, ImageF(32, 24, 3));
    for (ImageF& render : renders)
        for (int y = 0; y < render.height; ++y)
            for (int x = 0; x < render.width; ++x)
                for (float& value : render.pixel(x, y)) {
                    double sum = 0.0;
                    for (int sample = 0; sample < 16; ++sample) sum += noise(generator);
                    value = static_cast<float>(sum / 16.0 + (x < 8 && y < 8 ? extra : 0.0));
                }
    return estimate_image(renders);
}

TEST(EstimateImage, IsMeanAndVarianceOfTheMean) {
    std::vector<ImageF> renders(3, ImageF(1, 1, 2));
    renders[0].pixels = {1.0f, 5.0f};
    renders[1].pixels = {2.0f, 5.0f};
    renders[2].pixels = {6.0f, 5.0f};
    const ImageEstimate e = estimate_image(renders);
    EXPECT_EQ(e.mean.pixels, (std::vector<float>{3.0f, 5.0f}));
    // (4 + 1 + 9) / 2 / 3
    EXPECT_FLOAT_EQ(e.variance.pixels[0], 7.0f / 3.0f);
    EXPECT_EQ(e.variance.pixels[1], 0.0f);
}

TEST(EstimateImage, RefusesTooFewAndDifferentRenders) {
    EXPECT_THROW((void)estimate_image(std::vector<ImageF>(1, ImageF(1, 1, 1))), std::invalid_argument);
    EXPECT_THROW((void)estimate_image(std::vector<ImageF>{ImageF(1, 1, 1), ImageF(2, 1, 1)}), std::invalid_argument);
}

TEST(BlockAgreement, ComputesZFromBothVariances) {
    // 16 pixels a block: variances 0.16 / 16 and 0.09 / 16 · … make a standard error of 0.125.
    const ImageEstimate a = constant_estimate(4, 4, 1.25f, 0.16f);
    const ImageEstimate b = constant_estimate(4, 4, 1.0f, 0.09f);
    const BlockAgreement result = test_agreement(a, b, {.block_size = 4, .mean_tolerance = 1.0});
    EXPECT_EQ(result.tests, 1u);
    EXPECT_NEAR(result.worst.z, 2.0, 1e-6);
    EXPECT_NEAR(result.p_value, 0.0455002639, 1e-7);
    EXPECT_NEAR(result.mean_difference, 0.2, 1e-6);
    EXPECT_TRUE(result.agree());
}

TEST(BlockAgreement, SaysWhatItCouldSee) {
    ImageEstimate a = constant_estimate(12, 4, 1.0f, 0.16f);
    const ImageEstimate b = constant_estimate(12, 4, 1.0f, 0.0f);
    // Three blocks, of which one has no noise.
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) a.variance.pixel(x, y)[0] = 0.0f;
    const BlockAgreement result = test_agreement(a, b, {.block_size = 4});
    EXPECT_NEAR(result.block_error, 0.1, 1e-6);
    EXPECT_NEAR(result.mean_error, std::sqrt(32.0 * 0.16) / 48.0, 1e-6);
    EXPECT_FALSE(result.whole_image_only);
    const BlockAgreement whole = test_agreement(a, b, {.block_size = 16});
    EXPECT_NEAR(whole.block_error, result.mean_error, 1e-6);
    EXPECT_TRUE(whole.whole_image_only);
    EXPECT_NE(whole.str().find("of the whole image agree"), std::string::npos) << whole.str();
}

TEST(BlockAgreement, CorrectsForTheNumberOfBlocks) {
    ImageEstimate a = constant_estimate(8, 4, 1.0f, 0.16f);
    const ImageEstimate b = constant_estimate(8, 4, 1.0f, 0.09f);
    for (int y = 0; y < 4; ++y)
        for (int x = 4; x < 8; ++x) a.mean.pixel(x, y)[0] = 0.75f;
    const BlockAgreement result = test_agreement(a, b, {.block_size = 4, .mean_tolerance = 1.0});
    EXPECT_EQ(result.tests, 3u) << "two blocks and the whole image";
    EXPECT_EQ(result.worst.x, 4);
    EXPECT_EQ(result.worst.y, 0);
    EXPECT_NEAR(result.worst.z, -2.0, 1e-6);
    EXPECT_NEAR(result.p_value, 1.0 - std::pow(0.9544997361, 3.0), 1e-7);
}

TEST(BlockAgreement, CutsBlocksAtTheBorder) {
    const ImageEstimate a = constant_estimate(17, 20, 1.0f, 0.1f);
    EXPECT_EQ(test_agreement(a, a).tests, 5u);
    ImageEstimate brighter = a;
    for (int y = 16; y < 20; ++y) brighter.mean.pixel(16, y)[0] = 9.0f;
    const BlockAgreement result = test_agreement(brighter, a);
    EXPECT_EQ(result.worst.x, 16);
    EXPECT_EQ(result.worst.y, 16);
    EXPECT_NEAR(result.worst.mean_a, 9.0, 1e-12);
    EXPECT_FALSE(result.blocks_agree);
}

TEST(BlockAgreement, AcceptsIndependentRendersOfOneImage) {
    // At significance 0.01 one in a hundred pairs would fail by chance; these seeds do not. Their means are too noisy
    // for 1%.
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
        const BlockAgreement result =
            test_agreement(noisy_estimate(2 * seed, 0.0), noisy_estimate(2 * seed + 1, 0.0), {.block_size = 8});
        EXPECT_TRUE(result.blocks_agree) << result.str();
    }
}

TEST(BlockAgreement, FindsOneBlockThatDiffers) {
    const BlockAgreement result = test_agreement(noisy_estimate(1, 0.1), noisy_estimate(2, 0.0), {.block_size = 8});
    EXPECT_FALSE(result.blocks_agree) << result.str();
    EXPECT_EQ(result.worst.x, 0);
    EXPECT_EQ(result.worst.y, 0);
    EXPECT_GT(result.worst.z, 0.0);
}

TEST(BlockAgreement, FindsASmallDifferenceOfTheWholeImage) {
    // Every block is within its noise, all together are not.
    const ImageEstimate a = constant_estimate(32, 32, 1.0f, 0.01f);
    const ImageEstimate b = constant_estimate(32, 32, 1.04f, 0.01f);
    const BlockAgreement result = test_agreement(a, b, {.block_size = 8, .mean_tolerance = 1.0});
    EXPECT_FALSE(result.blocks_agree) << result.str();
    EXPECT_EQ(result.worst.width, 32);
    EXPECT_EQ(result.worst.height, 32);
}

TEST(BlockAgreement, HoldsTheImagesMeansToOnePercent) {
    const ImageEstimate a = constant_estimate(4, 4, 1.0f, 1.0f);
    const ImageEstimate nearly = constant_estimate(4, 4, 1.009f, 1.0f);
    const ImageEstimate off = constant_estimate(4, 4, 1.02f, 1.0f);
    EXPECT_TRUE(test_agreement(nearly, a).agree());
    EXPECT_TRUE(test_agreement(off, a).blocks_agree);
    EXPECT_FALSE(test_agreement(off, a).agree());
    EXPECT_NE(test_agreement(off, a).str().find("too much"), std::string::npos);
}

TEST(BlockAgreement, WithoutVarianceOnlyTheToleranceCounts) {
    const ImageEstimate a = constant_estimate(4, 4, 1.0f, 0.0f);
    const ImageEstimate b = constant_estimate(4, 4, 1.001f, 0.0f);
    EXPECT_TRUE(test_agreement(a, a).agree());
    EXPECT_FALSE(test_agreement(a, b).agree());
    EXPECT_TRUE(test_agreement(a, b, {.block_tolerance = 2e-3}).agree());
}

// Where chance has found no light, a block is black without variance, as if it were certain that there is none.
TEST(BlockAgreement, LeavesOutWhatIsBlackByChance) {
    constexpr AgreementOptions kOptions{.block_size = 4, .mean_tolerance = 1.0, .black_is_certain = false};
    const ImageEstimate lit = constant_estimate(8, 8, 1.0f, 0.01f);
    ImageEstimate partly = lit;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) partly.mean.pixel(x, y)[0] = partly.variance.pixel(x, y)[0] = 0.0f;
    AgreementOptions known = kOptions;
    known.black_is_certain = true;
    EXPECT_FALSE(test_agreement(partly, lit, known).agree());
    const BlockAgreement result = test_agreement(partly, lit, kOptions);
    EXPECT_TRUE(result.agree()) << result.str();
    EXPECT_EQ(result.black_in_a, 1u);
    EXPECT_EQ(test_agreement(lit, partly, kOptions).black_in_b, 1u);
    partly.mean.pixel(7, 7)[0] = 3.0f;
    EXPECT_FALSE(test_agreement(partly, lit, kOptions).agree()) << "it differs elsewhere, too";
    EXPECT_EQ(test_agreement(partly, partly, kOptions).black_in_a, 0u) << "both are black there";
}

TEST(BlockAgreement, WhatIsNoNumberDoesNotAgree) {
    const ImageEstimate a = constant_estimate(4, 4, 1.0f, 0.1f);
    ImageEstimate b = a;
    b.mean.pixels[3] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(test_agreement(a, b).blocks_agree);
    EXPECT_FALSE(test_agreement(a, b).means_agree);
}

TEST(BlockAgreement, RefusesImagesOfDifferentShape) {
    EXPECT_THROW((void)test_agreement(constant_estimate(4, 4, 1, 1), constant_estimate(4, 5, 1, 1)),
                 std::invalid_argument);
}

/// Noise in which every value is the mean of the `reach` × `reach` ones around it.
std::vector<ImageF> blurred_noise(int reach) {
    std::mt19937 generator(3);
    std::exponential_distribution<float> noise(1.0f);
    std::vector<ImageF> renders(8, ImageF(96, 96, 1));
    for (ImageF& render : renders) {
        ImageF sharp(render.width + reach, render.height + reach, 1);
        for (float& value : sharp.pixels) value = noise(generator);
        for (int y = 0; y < render.height; ++y)
            for (int x = 0; x < render.width; ++x)
                for (int v = 0; v < reach; ++v)
                    for (int u = 0; u < reach; ++u)
                        render.pixel(x, y)[0] += sharp.pixel(x + u, y + v)[0] / static_cast<float>(reach * reach);
    }
    return renders;
}

// The variance of a block of 16 × 16 means of 3 × 3 values is 9 times that of independent ones, less at its edges: each
// value lies within the block for (1 - 2 / (3 · 16))² of ... its neighbours, and 36 blocks of 8 renders tell it within
// 9%.
TEST(WidenForCorrelation, FindsHowMuchBlocksVaryMore) {
    const std::vector<ImageF> independent = blurred_noise(1);
    ImageEstimate estimate = estimate_image(independent);
    EXPECT_NEAR(widen_for_correlation(estimate, independent, 16), 1.0, 0.3);
    const std::vector<ImageF> blurred = blurred_noise(3);
    estimate = estimate_image(blurred);
    const float before = estimate.variance.pixels[5];
    const double factor = widen_for_correlation(estimate, blurred, 16);
    EXPECT_NEAR(factor, 9.0 * std::pow(1.0 - 8.0 / (9.0 * 16.0), 2), 2.0);
    EXPECT_FLOAT_EQ(estimate.variance.pixels[5], before * static_cast<float>(factor));
}

TEST(TestableBlockSize, GrowsUntilManyValuesCount) {
    // Flat but for bright pixels that are the light of their surroundings, as where it is found by chance.
    const auto render = [](int spacing) {
        ImageF image(64, 64, 1);
        image.pixels.assign(image.pixels.size(), 0.01f);
        for (int y = 0; y < 64; y += spacing)
            for (int x = 0; x < 64; x += spacing) image.pixel(x, y)[0] = 100.0f;
        return image;
    };
    EXPECT_EQ(testable_block_size(std::vector<ImageF>(2, render(1)), 16), 16);
    // 8 of them in 16 × 16 pixels of two renders, 32 in 32 × 32, 128 in 64 × 64.
    EXPECT_EQ(testable_block_size(std::vector<ImageF>(2, render(8)), 16), 64);
    EXPECT_FALSE(testable_block_size(std::vector<ImageF>(2, render(32)), 16));
    EXPECT_FALSE(testable_block_size(std::vector<ImageF>(2, ImageF(64, 64, 1)), 16)) << "black";
    std::vector<ImageF> few(3, ImageF(11, 3, 1));
    for (ImageF& image : few) image.pixels.assign(image.pixels.size(), 1.0f);
    EXPECT_FALSE(testable_block_size(few, 16)) << "99 values";
    few.push_back(few.front());
    EXPECT_TRUE(testable_block_size(few, 16));
}

TEST(TestableBlockSize, GrowsUntilMoreThanAFewValuesVary) {
    // As bright everywhere, and a little brighter in single pixels of the first render.
    const auto renders = [](int spacing) {
        std::vector<ImageF> images(2, ImageF(64, 64, 1));
        for (ImageF& image : images) image.pixels.assign(image.pixels.size(), 1.0f);
        for (int y = 0; y < 64; y += spacing)
            for (int x = 0; x < 64; x += spacing) images[0].pixel(x, y)[0] = 1.5f;
        return images;
    };
    EXPECT_EQ(testable_block_size(renders(8), 16), 16);
    // One pixel that varies in 16 × 16, in two renders two values; 4 in 32 × 32.
    EXPECT_EQ(testable_block_size(renders(16), 16), 32);
    EXPECT_EQ(testable_block_size(renders(64), 16), 64) << "the whole image is tested however few vary";
}

TEST(PoolVariance, RaisesToTheMeanAround) {
    ImageEstimate estimate = constant_estimate(48, 48, 1.0f, 1.0f);
    for (int y = 16; y < 32; ++y)
        for (int x = 16; x < 32; ++x) estimate.variance.pixel(x, y)[0] = 10.0f;
    pool_variance(estimate, 16);
    EXPECT_FLOAT_EQ(estimate.variance.pixel(20, 20)[0], 10.0f) << "never lowered";
    EXPECT_FLOAT_EQ(estimate.variance.pixel(20, 0)[0], (5.0f + 10.0f) / 6.0f);
    EXPECT_FLOAT_EQ(estimate.variance.pixel(0, 0)[0], (3.0f + 10.0f) / 4.0f);
}

/// Renders of an image that is 1 everywhere: most of it with a little noise; `rare` of its light in flashes, of which
/// there are `flashes` in a block of 16 × 16 pixels and all renders, on average.
std::vector<ImageF> flashing_renders(std::mt19937& generator, double rare, double flashes) {
    constexpr int kRenders = 8;
    std::normal_distribution<float> noise(static_cast<float>(1.0 - rare), 0.05f);
    const double probability = flashes / (16.0 * 16.0 * kRenders);
    std::bernoulli_distribution flash(probability);
    std::vector<ImageF> renders(kRenders, ImageF(128, 128, 1));
    for (ImageF& render : renders)
        for (float& value : render.pixels)
            value = noise(generator) + (flash(generator) ? static_cast<float>(rare / probability) : 0.0f);
    return renders;
}

// Of 300 comparisons of right images 1% may fail: more than 9 do with a probability of 0.1%. Without pooled variances
// 14 failed, without a look at how many values vary 8 did, without both 234.
TEST(BlockAgreement, RareFlashesAreNoDisagreement) {
    std::mt19937 generator(1);
    int failed = 0;
    for (const double flashes : {0.5, 1.0, 2.0, 5.0, 20.0})
        for (int i = 0; i < 60; ++i) {
            const std::vector<ImageF> a = flashing_renders(generator, 0.05, flashes);
            const std::vector<ImageF> b = flashing_renders(generator, 0.0, 1.0);
            const int size = testable_block_size(a, 16).value();
            ImageEstimate of_a = estimate_image(a);
            pool_variance(of_a, size);
            if (!test_agreement(of_a, estimate_image(b), {.block_size = size, .mean_tolerance = 1.0}).agree()) ++failed;
        }
    EXPECT_LE(failed, 9);
}

TEST(RelativeVariance, IsRelativeToTheBlocksMean) {
    EXPECT_NEAR(relative_variance(constant_estimate(16, 16, 2.0f, 0.5f)), 0.5 / 4.01, 1e-6);
    // One bright pixel of 256, with the variance of a firefly: its own mean would hide it.
    ImageEstimate firefly = constant_estimate(16, 16, 0.0f, 0.0f);
    firefly.mean.pixel(3, 3)[0] = 256.0f;
    firefly.variance.pixel(3, 3)[0] = 65536.0f;
    EXPECT_NEAR(relative_variance(firefly), 65536.0 / 256.0 / 1.01, 1e-2);
}

TEST(AgreementMap, ShowsTheLargestZOfEachBlock) {
    ImageEstimate a = constant_estimate(8, 4, 1.0f, 0.16f);
    const ImageEstimate b = constant_estimate(8, 4, 1.0f, 0.09f);
    for (int y = 0; y < 4; ++y)
        for (int x = 4; x < 8; ++x) a.mean.pixel(x, y)[0] = 1.25f;
    const ImageF map = agreement_map(a, b, {.block_size = 4});
    EXPECT_EQ(map.pixel(0, 0)[0], 0.0f);
    EXPECT_NEAR(map.pixel(7, 3)[0], 2.0, 1e-5);
}

TEST(SmallestDifference, IsSeenNineTimesInTen) {
    // One test of 5%: 1.959964 + 1.281552 standard errors.
    EXPECT_NEAR(smallest_difference(0.01, 0.05, 1), 0.03241516, 1e-8);
    std::mt19937 generator(7);
    const double difference = smallest_difference(1.0, 0.01, 100);
    std::normal_distribution<double> estimate(difference, 1.0);
    int seen = 0;
    for (int i = 0; i < 20000; ++i) seen += std::abs(estimate(generator)) > critical_z(0.01, 100) ? 1 : 0;
    // Within 5 standard deviations of the binomial distribution.
    EXPECT_NEAR(seen / 20000.0, kPower, 5.0 * std::sqrt(0.09 / 20000.0));
}

TEST(CriticalZ, IsThatOfTheNormalDistribution) {
    EXPECT_NEAR(critical_z(0.05, 1), 1.959964, 1e-6);
    EXPECT_NEAR(critical_z(0.01, 1), 2.575829, 1e-6);
    // 1 - 0.99^(1/1000) of one test.
    EXPECT_NEAR(std::erfc(critical_z(0.01, 1000) / std::sqrt(2.0)), 1.005028e-5, 1e-10);
}

}  // namespace
}  // namespace etendue
