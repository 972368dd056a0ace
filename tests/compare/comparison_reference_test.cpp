#include "compare/comparison_reference.h"

#include "metrics/error_metrics.h"

#include <array>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

Variant variant(const std::string& integrator, const std::string& name = "") {
    Variant result{.name = name.empty() ? integrator : name};
    result.settings.integrator.type = integrator;
    return result;
}

/// Renders of a grey image, three unless `count` says.
FinishedImages finished(float grey, float noise, std::uint32_t seed, int count = 3) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<float> spread(-noise, noise);
    FinishedImages images;
    for (int round = 0; round < count; ++round) {
        ImageF image(32, 32, 3);
        for (float& value : image.pixels) value = grey + (noise > 0.0f ? spread(generator) : 0.0f);
        images.of_seeds.push_back(image);
    }
    images.estimate = estimate_image(images.of_seeds);
    images.relative_variance = count * relative_variance(images.estimate);
    images.block_size = 16;
    return images;
}

struct Pooled {
    std::vector<PairReport> pairs;
    std::optional<Reference> reference;
    std::string notes;
};

Pooled pool(const std::vector<Variant>& variants, const std::vector<FinishedImages>& images) {
    Pooled result{.pairs = compare_pairs(variants, images), .reference = {}, .notes = {}};
    std::vector<std::string> notes;
    result.reference = pool_reference(variants, images, result.pairs, notes);
    for (const std::string& note : notes) result.notes += note + "\n";
    return result;
}

std::vector<Variant> variants(std::initializer_list<const char*> integrators) {
    std::vector<Variant> result;
    for (const char* integrator : integrators) result.push_back(variant(integrator));
    return result;
}

TEST(PoolReference, WeighsByOneOverTheVariance) {
    const std::vector<FinishedImages> images{finished(0.5f, 0.2f, 1), finished(0.5f, 0.1f, 2)};
    const Pooled pooled = pool(variants({"path", "bdpt"}), images);
    ASSERT_TRUE(pooled.reference) << pooled.notes;
    EXPECT_NEAR(pooled.reference->report().weights.at("bdpt"), 0.8, 0.02);
    EXPECT_TRUE(pooled.notes.empty()) << pooled.notes;
}

TEST(PoolReference, ItsNoiseIsNoPartOfSquaredErrors) {
    constexpr float kGrey = 100.0f;  // far above the noise, so that relMSE is MSE over its square
    constexpr int kTrials = 40, kRounds = 4;
    constexpr std::array kNoise{1.0f, 2.0f};
    std::array<double, 2> mse{};
    std::array<double, 2> rel_mse{};
    for (std::uint32_t trial = 0; trial < kTrials; ++trial) {
        std::vector<FinishedImages> images;
        for (std::uint32_t v = 0; v < 2; ++v) images.push_back(finished(kGrey, kNoise.at(v), 2 * trial + v, kRounds));
        const Pooled pooled = pool(variants({"path", "bdpt"}), images);
        if (!pooled.reference) continue;  // a test in a hundred fails by chance
        for (std::size_t v = 0; v < 2; ++v)
            for (std::size_t round = 0; round < kRounds; ++round) {
                const ErrorMetrics errors =
                    compute_error_metrics(images[v].of_seeds[round], pooled.reference->of_round(round), {},
                                          pooled.reference->variance_of_round(round));
                mse.at(v) += errors.mse;
                rel_mse.at(v) += errors.rel_mse;
            }
    }
    // Of a million values the variance is known to 0.2%; the noise of the reference would be a quarter of the first.
    EXPECT_NEAR(mse[0] / mse[1], 0.25, 0.0025);
    EXPECT_NEAR(mse[0] / (kTrials * kRounds), 1.0 / 3.0, 0.05);
    EXPECT_NEAR(rel_mse[0] / rel_mse[1], 0.25, 0.0025);
}

TEST(PoolReference, WhatHasNoVarianceHasAllTheWeight) {
    const std::vector<FinishedImages> images{finished(0.5f, 0.0f, 1), finished(0.5f, 0.01f, 2),
                                             finished(0.5f, 0.0f, 3)};
    const Pooled pooled = pool(variants({"path", "bdpt", "naive"}), images);
    ASSERT_TRUE(pooled.reference) << pooled.notes;
    EXPECT_EQ(pooled.reference->report().weights,
              (std::map<std::string, double>{{"path", 0.5}, {"bdpt", 0.0}, {"naive", 0.5}}));
    EXPECT_EQ(pooled.reference->report().noise_rel_mse, 0.0);
    EXPECT_FLOAT_EQ(pooled.reference->of_round(1).pixels[7], 0.5f);
}

TEST(PoolReference, IsNotMadeOfImagesThatDisagree) {
    const std::vector<FinishedImages> images{finished(0.5f, 0.1f, 1), finished(0.6f, 0.1f, 2)};
    const Pooled pooled = pool(variants({"path", "bdpt"}), images);
    EXPECT_FALSE(pooled.reference);
    EXPECT_FALSE(pooled.pairs[0].agreement->agree());
    EXPECT_NE(pooled.notes.find("do not make the same image"), std::string::npos) << pooled.notes;
}

TEST(PoolReference, LeavesOutWhatCannotBeTested) {
    std::vector<FinishedImages> images{finished(0.5f, 0.1f, 1), finished(0.5f, 0.1f, 2), finished(0.5f, 0.1f, 3)};
    images[0].block_size.reset();
    const Pooled pooled = pool(variants({"path", "bdpt", "vcm"}), images);
    ASSERT_TRUE(pooled.reference) << pooled.notes;
    EXPECT_FALSE(pooled.reference->report().weights.contains("path"));
    EXPECT_NE(pooled.notes.find("no part of 'path': so few bright pixels"), std::string::npos) << pooled.notes;
    images[2].block_size.reset();
    const Pooled none = pool(variants({"path", "bdpt", "vcm"}), images);
    EXPECT_FALSE(none.reference);
    EXPECT_NE(none.notes.find("the image of 'path' and 'vcm', or parts of it, that no test"), std::string::npos)
        << none.notes;
}

TEST(PoolReference, IsOfTheLightThatMostVariantsShow) {
    std::vector<Variant> all = variants({"direct", "path", "bdpt"});
    const std::vector<FinishedImages> images{finished(0.3f, 0.1f, 1), finished(0.5f, 0.1f, 2), finished(0.5f, 0.1f, 3)};
    const Pooled pooled = pool(all, images);
    ASSERT_TRUE(pooled.reference) << pooled.notes;
    EXPECT_EQ(pooled.reference->report().weights.size(), 2u);
    EXPECT_NE(pooled.notes.find("errors of 'direct'"), std::string::npos) << pooled.notes;
    // As many of one as of the other: no telling which is meant.
    all.push_back(variant("direct", "again"));
    std::vector<FinishedImages> more = images;
    more.push_back(finished(0.3f, 0.1f, 4));
    const Pooled tie = pool(all, more);
    EXPECT_FALSE(tie.reference);
    EXPECT_NE(tie.notes.find("different light, and as many of them"), std::string::npos) << tie.notes;
}

TEST(PoolReference, SaysThatOneAlgorithmAloneMadeIt) {
    std::vector<Variant> all;
    for (const char* heuristic : {"power", "balance"}) all.push_back(variant("bdpt", heuristic));
    const std::vector<FinishedImages> images{finished(0.5f, 0.1f, 1), finished(0.5f, 0.1f, 2)};
    const Pooled pooled = pool(all, images);
    ASSERT_TRUE(pooled.reference) << pooled.notes;
    EXPECT_NE(pooled.notes.find("comes from 'bdpt' alone"), std::string::npos) << pooled.notes;
}

TEST(ReferenceNotes, SayWhatItLacks) {
    Variant reference = variant("light");
    reference.cannot_find = {"mirrors stay black"};
    const std::vector<Variant> all = variants({"path", "light", "direct"});
    std::string notes;
    for (const std::string& note : reference_notes(reference, all)) notes += note + "\n";
    for (const char* part : {"lacks light, as 'light' makes it: mirrors stay black", "'light' is measured against",
                             "errors of 'direct' are against an image of different light"})
        EXPECT_NE(notes.find(part), std::string::npos) << part << " in " << notes;
    EXPECT_EQ(notes.find("'path' is"), std::string::npos) << notes;
}

}  // namespace

}  // namespace etendue::test
