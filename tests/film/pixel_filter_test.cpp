#include "film/pixel_filter.h"

#include "support/chi2.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

struct FilterCase {
    std::string name;
    FilterShape shape;
    float radius;
    float expected_radius;
};

const std::vector<FilterCase> kFilters = {{"BlackmanHarris", FilterShape::BlackmanHarris, 0.0f, 1.5f},
                                          {"Box", FilterShape::Box, 0.0f, 0.5f},
                                          {"Gaussian", FilterShape::Gaussian, 0.0f, 1.5f},
                                          {"Mitchell", FilterShape::Mitchell, 0.0f, 2.0f},
                                          {"WideBlackmanHarris", FilterShape::BlackmanHarris, 3.0f, 3.0f},
                                          {"WideBox", FilterShape::Box, 1.25f, 1.25f},
                                          {"NarrowMitchell", FilterShape::Mitchell, 1.0f, 1.0f}};

class Filters : public testing::TestWithParam<FilterCase> {
  protected:
    PixelFilter filter_{GetParam().shape, GetParam().radius};
};

TEST_P(Filters, IntegrateToOneAndAreSymmetric) {
    EXPECT_EQ(filter_.radius(), GetParam().expected_radius);
    constexpr int kCells = 20'000;
    const float r = filter_.radius();
    double sum = 0.0;
    for (int i = 0; i < kCells; ++i) {
        const float x = r * (2.0f * (static_cast<float>(i) + 0.5f) / kCells - 1.0f);
        sum += static_cast<double>(filter_.evaluate(x));
        EXPECT_NEAR(filter_.evaluate(x), filter_.evaluate(-x), 1e-5f);
    }
    EXPECT_NEAR(sum * 2.0 * static_cast<double>(r) / kCells, 1.0, 1e-4);
    EXPECT_EQ(filter_.evaluate(r * 1.001f), 0.0f);
    EXPECT_EQ(filter_.evaluate(-r * 1.001f), 0.0f);
}

TEST_P(Filters, EstimateAnyImageAsTheirIntegralWould) {
    // The weighted histogram of samples along x must be the filter.
    constexpr int kBins = 20;
    constexpr int kSamples = 400'000;
    const float r = filter_.radius();
    std::vector<double> sums(kBins);
    std::vector<double> squares(kBins);
    double mean = 0.0;
    double mean_square = 0.0;
    Random random(12);
    for (int i = 0; i < kSamples; ++i) {
        const PixelFilter::Sample s = filter_.sample(random.next_2d());
        ASSERT_LE(std::abs(s.offset.x), r);
        ASSERT_LE(std::abs(s.offset.y), r);
        const auto bin = std::min(kBins - 1, static_cast<int>((s.offset.x / r + 1.0f) * 0.5f * kBins));
        const auto weight = static_cast<double>(s.weight);
        sums[static_cast<std::size_t>(bin)] += weight;
        squares[static_cast<std::size_t>(bin)] += weight * weight;
        mean += weight;
        mean_square += weight * weight;
    }
    mean /= kSamples;
    // 4.5 standard errors; for filters without negative parts the weight hardly varies.
    EXPECT_NEAR(mean, 1.0, 4.5 * std::sqrt((mean_square / kSamples - mean * mean) / kSamples) + 1e-3);
    for (int b = 0; b < kBins; ++b) {
        double expected = 0.0;
        constexpr int kSteps = 200;
        for (int i = 0; i < kSteps; ++i)
            expected +=
                static_cast<double>(filter_.evaluate(
                    r * (2.0f * (static_cast<float>(b) + (static_cast<float>(i) + 0.5f) / kSteps) / kBins - 1.0f))) *
                2.0 * static_cast<double>(r) / kBins / kSteps;
        const auto i = static_cast<std::size_t>(b);
        const double error = std::sqrt(squares[i]) / kSamples;
        // The density is constant within cells of 1/512 of the mass, so a bin's share is exact up to one of them.
        EXPECT_NEAR(sums[i] / kSamples, expected, 4.5 * error + 1.0 / 512.0) << "bin " << b;
    }
}

TEST_P(Filters, SamplesHaveTheirDensity) {
    // Of numbers at equal steps, as many lie below any offset as the density integrates to.
    constexpr int kSteps = 100'000;
    const float r = filter_.radius();
    const float step = 2.0f * r / kSteps;
    double integral = 0.0;
    int i = 0;
    for (int k = 0; k < kSteps; ++k) {
        const float x = r * (2.0f * (static_cast<float>(k) + 0.5f) / kSteps - 1.0f);
        integral += static_cast<double>(filter_.pdf(x) * step);
        while (i < kSteps && filter_.sample({(static_cast<float>(i) + 0.5f) / kSteps, 0.5f}).offset.x < x) ++i;
        if (k % 100 == 0) {
            EXPECT_NEAR(integral, static_cast<double>(i) / kSteps, 1e-3) << x;
        }
    }
    EXPECT_NEAR(integral, 1.0, 1e-3);
    EXPECT_EQ(filter_.pdf(r * 1.001f), 0.0f);
    EXPECT_EQ(filter_.pdf(-r * 1.001f), 0.0f);
}

TEST_P(Filters, MovesOppositelyForOppositeNumbers) {
    // Symmetric filters sampled by inversion: u and 1 - u lie on opposite sides.
    for (const float u : {0.1f, 0.25f, 0.4f}) {
        const PixelFilter::Sample low = filter_.sample({u, 0.5f});
        const PixelFilter::Sample high = filter_.sample({1.0f - u, 0.5f});
        EXPECT_NEAR(low.offset.x, -high.offset.x, 1e-4f * filter_.radius());
        EXPECT_LT(low.offset.x, 0.0f);
    }
}

INSTANTIATE_TEST_SUITE_P(PixelFilter, Filters, testing::ValuesIn(kFilters),
                         [](const auto& param) { return param.param.name; });

TEST(PixelFilter, MitchellsSamplesCountNegativelyWhereTheFilterIs) {
    const PixelFilter filter(FilterShape::Mitchell);
    EXPECT_LT(filter.evaluate(1.5f), 0.0f);
    Random random(1);
    bool negative = false;
    for (int i = 0; i < 2000 && !negative; ++i) negative = filter.sample(random.next_2d()).weight < 0.0f;
    EXPECT_TRUE(negative);
}

// Harris, "On the Use of Windows for Harmonic Analysis with the Discrete Fourier Transform" (1978), table 1: the four
// terms of the window of -92 dB. Over its mean, the first term, and the width of 3 pixels.
TEST(PixelFilter, BlackmanHarrisIsThePublishedWindow) {
    const PixelFilter filter(FilterShape::BlackmanHarris);
    constexpr double kTerms[] = {0.35875, 0.48829, 0.14128, 0.01168};
    for (const double t : {0.0, 0.25, 0.5, 0.75, 0.95}) {
        double window = 0.0;
        for (int k = 0; k < 4; ++k) window += kTerms[k] * std::cos(k * std::numbers::pi * t);
        EXPECT_NEAR(static_cast<double>(filter.evaluate(static_cast<float>(1.5 * t))), window / kTerms[0] / 3.0, 3e-6)
            << t;
    }
}

// Mitchell and Netravali's cubic of B = C = 1/3: 8/9 in the middle, 1/18 at one pixel and -5/144 at one
// and a half.
TEST(PixelFilter, MitchellIsThePublishedCubic) {
    const PixelFilter filter(FilterShape::Mitchell);
    EXPECT_NEAR(filter.evaluate(0.0f), 8.0f / 9.0f, 1e-5f);
    EXPECT_NEAR(filter.evaluate(1.0f), 1.0f / 18.0f, 1e-5f);
    EXPECT_NEAR(filter.evaluate(1.5f), -5.0f / 144.0f, 1e-5f);
}

// exp(-4.5 t²) less its value at the edge.
TEST(PixelFilter, GaussianFallsByItsStandardDeviationAThirdOfTheRadius) {
    const PixelFilter filter(FilterShape::Gaussian);
    const double edge = std::exp(-4.5);
    for (const double t : {0.25, 0.5, 0.75})
        EXPECT_NEAR(static_cast<double>(filter.evaluate(static_cast<float>(1.5 * t)) / filter.evaluate(0.0f)),
                    (std::exp(-4.5 * t * t) - edge) / (1.0 - edge), 1e-5)
            << t;
}

TEST(PixelFilter, TheBoxIsFlat) {
    const PixelFilter filter(FilterShape::Box);
    EXPECT_NEAR(filter.evaluate(0.0f), 1.0f, 1e-6f);
    EXPECT_NEAR(filter.evaluate(0.499f), 1.0f, 1e-6f);
    Random random(1);
    for (int i = 0; i < 100; ++i) EXPECT_NEAR(filter.sample(random.next_2d()).weight, 1.0f, 1e-5f);
}

}  // namespace

}  // namespace etendue::test
