#include "film/deep.h"

#include "support/random.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

DeepBin bin(float depth, double alpha, double gray = 0.0, double splat = 0.0) {
    return {.front = depth,
            .back = depth,
            .alpha = alpha,
            .r = gray,
            .g = 2.0 * gray,
            .b = 3.0 * gray,
            .splat_r = splat,
            .splat_g = splat,
            .splat_b = splat};
}

/// Composites samples as every program does: front to back, each over what follows.
std::array<double, 4> flattened(const std::vector<DeepSample>& samples) {
    std::array<double, 4> sum{};
    for (const DeepSample& s : samples) {
        const double through = 1.0 - sum[3];
        sum[0] += through * static_cast<double>(s.r);
        sum[1] += through * static_cast<double>(s.g);
        sum[2] += through * static_cast<double>(s.b);
        sum[3] += through * static_cast<double>(s.alpha);
    }
    return sum;
}

std::vector<float> fronts(const DeepBuffer& deep, std::size_t pixel) {
    std::vector<float> depths;
    for (const DeepBin& each : deep.bins(pixel)) depths.push_back(each.front);
    return depths;
}

TEST(DeepBuffer, KeepsDepthsApartAndInOrder) {
    DeepBuffer deep;
    deep.reset(2);
    for (const float depth : {3.0f, 1.0f, 2.0f, 1.005f, kDeepBackground}) deep.add(1, bin(depth, 1.0, 0.5));
    EXPECT_TRUE(deep.bins(0).empty());
    ASSERT_EQ(fronts(deep, 1), (std::vector<float>{1.0f, 2.0f, 3.0f, kDeepBackground}));
    EXPECT_EQ(deep.bins(1)[0].back, 1.005f);
    EXPECT_EQ(deep.bins(1)[0].alpha, 2.0);
    EXPECT_EQ(deep.bins(1)[0].g, 2.0);
    deep.reset(2);
    EXPECT_TRUE(deep.bins(1).empty());
}

TEST(DeepBuffer, DoesNotGrowABinByManySmallSteps) {
    DeepBuffer deep;
    deep.reset(1);
    for (int i = 0; i < 100; ++i) deep.add(0, bin(1.0f + 0.001f * static_cast<float>(i), 1.0));
    EXPECT_GE(deep.bins(0).size(), 5u) << "a tenth, by hundredths";
    for (const DeepBin& each : deep.bins(0)) EXPECT_LT(each.back / each.front, 1.021f);
}

TEST(DeepBuffer, JoinsTheNearestWhenItIsFullAndLosesNothing) {
    DeepBuffer deep;
    deep.reset(1);
    Random random(5);
    double alpha = 0.0;
    double red = 0.0;
    for (int i = 0; i < 1000; ++i) {
        const Vec2f u = random.next_2d();
        deep.add(0, bin(1.0f + 100.0f * u.x * u.x, static_cast<double>(u.y), 0.5));
        alpha += static_cast<double>(u.y);
        red += 0.5;
    }
    ASSERT_EQ(deep.bins(0).size(), DeepBuffer::kMostBins);
    for (std::size_t i = 0; i < deep.bins(0).size(); ++i) {
        const DeepBin& each = deep.bins(0)[i];
        alpha -= each.alpha;
        red -= each.r;
        EXPECT_LE(each.front, each.back);
        EXPECT_LT(i > 0 ? deep.bins(0)[i - 1].back : 0.0f, each.front);
    }
    EXPECT_NEAR(alpha, 0.0, 1e-9);
    EXPECT_NEAR(red, 0.0, 1e-9);
}

// Else memory would be twice what is told of it.
TEST(DeepBuffer, HasNoRoomForMoreThanThereMayBe) {
    Random random(6);
    for (const bool with_splats : {false, true}) {
        DeepBuffer deep;
        deep.reset(1);
        for (int i = 0; i < 1000; ++i) {
            deep.add(0, bin(1.0f + 100.0f * random.next(), 1.0));
            if (with_splats) deep.add(0, bin(-1.0f - 100.0f * random.next(), 0.0, 0.0, 1.0));
        }
        EXPECT_EQ(deep.bytes(), DeepBuffer::most_bytes(with_splats));
        DeepBuffer copy = deep;  // has no room to begin with
        copy.reset(1);
        for (int i = 0; i < 9; ++i) copy.add(0, bin(1.0f + static_cast<float>(i), 1.0));
        DeepBuffer small = copy;
        for (int i = 0; i < 1000; ++i) small.add(0, bin(1.0f + 100.0f * random.next(), 1.0));
        EXPECT_EQ(small.bytes(), DeepBuffer::most_bytes(false));
    }
}

// Tiles and splats come in turns that depend on how fast the machine is.
TEST(DeepBuffer, DoesNotDependOnWhenSplatsCome) {
    std::vector<DeepBin> samples;
    std::vector<DeepBin> splats;
    Random random(11);
    for (int i = 0; i < 100; ++i) {
        samples.push_back(bin(1.0f + random.next(), 1.0, 0.5));
        splats.push_back(bin(-1.0f - random.next(), 0.0, 0.0, 0.25));
    }
    DeepBuffer deep;
    deep.reset(2);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        deep.add(0, samples[i]);
        deep.add(0, splats[i]);
    }
    for (const DeepBin& each : splats) deep.add(1, each);
    for (const DeepBin& each : samples) deep.add(1, each);
    ASSERT_EQ(deep.bins(0).size(), deep.bins(1).size());
    EXPECT_EQ(deep.bins(0).size(), 2 * DeepBuffer::kMostBins);
    for (std::size_t i = 0; i < deep.bins(0).size(); ++i) {
        EXPECT_EQ(deep.bins(0)[i].front, deep.bins(1)[i].front);
        EXPECT_EQ(deep.bins(0)[i].back, deep.bins(1)[i].back);
        EXPECT_EQ(deep.bins(0)[i].alpha, deep.bins(1)[i].alpha);
        EXPECT_EQ(deep.bins(0)[i].splat_g, deep.bins(1)[i].splat_g);
    }
}

TEST(DeepSamples, AreAlphasOfWhatIsLeft) {
    const std::vector<DeepBin> bins{bin(1.0f, 2.0, 0.2), bin(2.0f, 1.0, 0.4), bin(3.0f, 1.0, 0.1)};
    const std::vector<DeepSample> samples = deep_samples(bins, 0.25, 1.0);
    ASSERT_EQ(samples.size(), 3u);
    EXPECT_FLOAT_EQ(samples[0].alpha, 0.5f);
    EXPECT_FLOAT_EQ(samples[0].g, 0.1f);
    EXPECT_FLOAT_EQ(samples[1].alpha, 0.5f);
    EXPECT_FLOAT_EQ(samples[1].r, 0.2f);
    EXPECT_FLOAT_EQ(samples[2].alpha, 1.0f);
    EXPECT_FLOAT_EQ(samples[2].r, 0.1f);
    EXPECT_EQ(samples[1].front, 2.0f);
}

// The sky that a filter's rounding leaves behind a wall does not make the wall as deep as the sky.
TEST(DeepSamples, DoNotReachToWhatTheyHide) {
    const std::vector<DeepBin> bins{bin(1.0f, 2.0, 0.2), bin(2.0f, 2.0 - 1e-6, 0.4), bin(kDeepBackground, 1e-5, 0.1)};
    const std::vector<DeepSample> samples = deep_samples(bins, 0.25, 1.0);
    ASSERT_EQ(samples.size(), 2u);
    EXPECT_EQ(samples[1].front, 2.0f);
    EXPECT_EQ(samples[1].back, 2.0f);
    EXPECT_NEAR(flattened(samples)[0], 0.175, 1e-6) << "its light is not lost";
}

// Light without alpha, negative alpha and splats included.
TEST(DeepSamples, FlattenToTheSums) {
    Random random(9);
    for (int trial = 0; trial < 200; ++trial) {
        std::vector<DeepBin> bins;
        float depth = 0.5f;
        std::array<double, 4> sums{};
        constexpr int kBins = 12;
        for (int i = 0; i < kBins; ++i) {
            const Vec2f u = random.next_2d();
            depth += 0.1f + u.x;
            const double alpha = u.y < 0.2f ? 0.0 : u.y < 0.3f ? -0.01 : static_cast<double>(u.y);
            bins.push_back(bin(depth, alpha, static_cast<double>(u.x), static_cast<double>(random.next())));
            sums[3] += alpha;
        }
        const double scale = trial % 2 == 0 ? 1.0 / sums[3] : 1.0 / kBins;  // opaque, or not
        sums[3] *= scale;
        for (const DeepBin& each : bins) {
            sums[0] += each.r * scale + each.splat_r * 0.3;
            sums[1] += each.g * scale + each.splat_g * 0.3;
            sums[2] += each.b * scale + each.splat_b * 0.3;
        }
        const std::array<double, 4> flat = flattened(deep_samples(bins, scale, 0.3));
        for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(flat[c], sums[c], 1e-4 * std::max(1.0, sums[c])) << trial;
    }
}

TEST(DeepSamples, OfLightAloneHaveNoAlpha) {
    const std::vector<DeepBin> bins{bin(1.0f, 0.0, 0.0, 0.5), bin(2.0f, 0.0, 0.25)};
    const std::vector<DeepSample> samples = deep_samples(bins, 1.0, 1.0);
    ASSERT_EQ(samples.size(), 1u);
    EXPECT_EQ(samples[0].alpha, 0.0f);
    EXPECT_FLOAT_EQ(samples[0].r, 0.75f);
    EXPECT_TRUE(deep_samples({}, 1.0, 1.0).empty());
}

}  // namespace

}  // namespace etendue::test
