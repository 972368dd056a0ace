#include "medium/homogeneous_medium.h"

#include "support/random.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

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

// What arrives and what scatters, in the mean, is known: exp(-σ d) and albedo (1 - exp(-σ d)). Tolerance: five standard
// errors of weights of at most 3.
TEST(HomogeneousMedium, WeightsAreUnbiasedInEveryChannel) {
    const HomogeneousMedium medium{.extinction = {0.5f, 2.0f, 9.0f}, .single_scatter_albedo = {0.9f, 0.5f, 0.99f}};
    constexpr int kSamples = 200'000;
    constexpr float kDistance = 0.8f;
    const Rgb throughput{0.2f, 0.5f, 0.3f};
    Random random(1);
    Rgb arrived;
    Rgb scattered;
    for (int i = 0; i < kSamples; ++i) {
        const float u = random.next();
        const MediumSample s = medium.sample(throughput, kDistance, {u, random.next()});
        ASSERT_LE(max_component(throughput * s.weight), 1.0f + 1e-4f);
        (s.scatters ? scattered : arrived) += s.weight;
        ASSERT_LE(s.distance, kDistance);
    }
    const double tolerance = 5.0 * 3.0 / std::sqrt(static_cast<double>(kSamples));
    const Rgb passed = medium.transmittance(kDistance);
    const auto expect = [&](float sum, float exact) {
        EXPECT_NEAR(static_cast<double>(sum) / kSamples, static_cast<double>(exact), tolerance);
    };
    expect(arrived.r, passed.r);
    expect(arrived.g, passed.g);
    expect(arrived.b, passed.b);
    expect(scattered.r, 0.9f * (1.0f - passed.r));
    expect(scattered.g, 0.5f * (1.0f - passed.g));
    expect(scattered.b, 0.99f * (1.0f - passed.b));
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
