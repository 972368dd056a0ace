#include "medium/homogeneous_medium.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

std::array<double, 3> channels(const Rgb& color) {
    return {static_cast<double>(color.r), static_cast<double>(color.g), static_cast<double>(color.b)};
}

TEST(HomogeneousMedium, TransmittanceIsExponential) {
    const HomogeneousMedium medium{.extinction = {1.0f, 2.0f, 0.0f}};
    const Rgb passed = medium.transmittance(0.5f);
    EXPECT_FLOAT_EQ(passed.r, std::exp(-0.5f));
    EXPECT_FLOAT_EQ(passed.g, std::exp(-1.0f));
    EXPECT_EQ(passed.b, 1.0f);
    const Rgb far = medium.transmittance(std::numeric_limits<float>::infinity());
    EXPECT_EQ(far.r, 0.0f);
    EXPECT_EQ(far.b, 1.0f) << "an empty channel passes everything, however far";
}

TEST(HomogeneousMedium, WithoutScatteringLightArrives) {
    const HomogeneousMedium medium{.extinction = {1.0f, 2.0f, 3.0f}};
    const MediumSample sample = medium.sample(Rgb(1.0f), 0.7f, {0.9f, 0.5f});
    EXPECT_FALSE(sample.scatters);
    EXPECT_EQ(sample.distance, 0.7f);
    EXPECT_EQ(sample.weight, medium.transmittance(0.7f));
}

// What arrives and what scatters, in the mean, is known: exp(-σ d) and albedo (1 - exp(-σ d)). All numbers are taken at
// even steps, and the channels change at tenths: nothing but the last step before the end of the way is off, by less
// than its width times the largest weight, 5.
TEST(HomogeneousMedium, WeightsAreUnbiasedInEveryChannel) {
    const HomogeneousMedium medium{.extinction = {0.5f, 2.0f, 9.0f}, .single_scatter_albedo = {0.9f, 0.5f, 0.99f}};
    constexpr int kSteps = 50'000;
    constexpr int kChannelSteps = 10;
    constexpr float kDistance = 0.8f;
    const Rgb throughput{0.2f, 0.5f, 0.3f};
    std::array<double, 3> arrived{};
    std::array<double, 3> scattered{};
    for (int x = 0; x < kSteps; ++x)
        for (int y = 0; y < kChannelSteps; ++y) {
            const Vec2f u((static_cast<float>(x) + 0.5f) / kSteps, (static_cast<float>(y) + 0.5f) / kChannelSteps);
            const MediumSample s = medium.sample(throughput, kDistance, u);
            ASSERT_LE(max_component(throughput * s.weight), 1.0f + 1e-4f);
            ASSERT_LE(s.distance, kDistance);
            std::array<double, 3>& sums = s.scatters ? scattered : arrived;
            const std::array<double, 3> weight = channels(s.weight);
            for (std::size_t c = 0; c < 3; ++c) sums[c] += weight[c] / kSteps / kChannelSteps;
        }
    const Rgb passed = medium.transmittance(kDistance);
    const std::array<double, 3> arrives = channels(passed);
    const std::array<double, 3> scatters = channels(medium.single_scatter_albedo * (Rgb(1.0f) - passed));
    for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(arrived[c], arrives[c], 1e-4) << c;
        EXPECT_NEAR(scattered[c], scatters[c], 1e-4) << c;
    }
}

// The published fit in double precision, by another program.
TEST(HomogeneousMedium, AlbedoFromMultiscatterIsThePublishedFit) {
    const Rgb color{0.2f, 0.5f, 0.8f};
    for (const auto& [g, expected] :
         {std::pair{0.0f, Rgb(0.613357f, 0.911709f, 0.990589f)}, std::pair{0.5f, Rgb(0.760349f, 0.953816f, 0.995272f)},
          std::pair{-0.3f, Rgb(0.549607f, 0.888183f, 0.987800f)}}) {
        const Rgb albedo = HomogeneousMedium::albedo_from_multiscatter(color, g);
        EXPECT_NEAR(albedo.r, expected.r, 1e-5f) << g;
        EXPECT_NEAR(albedo.g, expected.g, 1e-5f) << g;
        EXPECT_NEAR(albedo.b, expected.b, 1e-5f) << g;
    }
}

TEST(HomogeneousMedium, AlbedoFromMultiscatterIsMonotonicAndReachesItsEnds) {
    EXPECT_NEAR(HomogeneousMedium::albedo_from_multiscatter(Rgb(0.0f), 0.0f).r, 0.0f, 5e-3f);
    EXPECT_NEAR(HomogeneousMedium::albedo_from_multiscatter(Rgb(1.0f), 0.0f).r, 1.0f, 1e-4f);
    float last = -1.0f;
    for (int i = 0; i <= 10; ++i) {
        const float albedo = HomogeneousMedium::albedo_from_multiscatter(Rgb(static_cast<float>(i) / 10.0f), 0.5f).g;
        EXPECT_GT(albedo, last);
        last = albedo;
    }
}

}  // namespace

}  // namespace etendue::test
