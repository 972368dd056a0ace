#include "bsdf/spectral_response.h"

#include <array>
#include <cmath>
#include <cstddef>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

TEST(SpectralResponse, WhiteStaysWhite) {
    const SpectralResponse response;
    constexpr int kSamples = 100'000;
    double r = 0.0;
    double g = 0.0;
    double b = 0.0;
    for (int i = 0; i < kSamples; ++i) {
        const Wavelength w = response.sample((static_cast<float>(i) + 0.5f) / kSamples);
        ASSERT_GE(w.nm, 380.0f);
        ASSERT_LE(w.nm, 780.0f);
        ASSERT_GE(min_component(w.weight), 0.0f);
        ASSERT_LE(max_component(w.weight), 3.0f + 1e-4f);
        r += static_cast<double>(w.weight.r);
        g += static_cast<double>(w.weight.g);
        b += static_cast<double>(w.weight.b);
    }
    EXPECT_NEAR(r / kSamples, 1.0, 1e-3);
    EXPECT_NEAR(g / kSamples, 1.0, 1e-3);
    EXPECT_NEAR(b / kSamples, 1.0, 1e-3);
}

TEST(SpectralResponse, WavelengthsRiseFromBlueToRed) {
    const SpectralResponse response;
    float last = 0.0f;
    for (const float u : {0.0f, 0.1f, 0.3f, 0.5f, 0.7f, 0.9f, 0x1.fffffep-1f}) {
        const float nm = response.sample(u).nm;
        EXPECT_GT(nm, last);
        last = nm;
    }
    const Rgb blue = response.sample(0.15f).weight;
    const Rgb red = response.sample(0.9f).weight;
    EXPECT_GT(blue.b, blue.r);
    EXPECT_GT(red.r, red.b);
}

// Whichever wavelength is drawn, the others are drawn with it, and their mean is that of all.
TEST(SpectralResponse, SharesOfSixteenWavelengthsAreThoseOfAll) {
    const SpectralResponse response;
    const auto flat = [](float) { return 0.3f; };
    const auto rising = [](float nm) { return (nm - 380.0f) / 400.0f; };
    const auto red = [](float nm) { return nm > 600.0f ? 1.0f : 0.0f; };
    constexpr int kSamples = 20'000;
    const auto compare = [&](const auto& share) {
        std::array<double, 3> all{};   // of one wavelength each
        std::array<double, 3> mean{};  // of 16 each
        std::array<double, 3> met{};   // by chance: what is met, times how often it is
        const auto add = [](std::array<double, 3>& sum, const Rgb& value) {
            sum[0] += static_cast<double>(value.r) / kSamples;
            sum[1] += static_cast<double>(value.g) / kSamples;
            sum[2] += static_cast<double>(value.b) / kSamples;
        };
        for (int i = 0; i < kSamples; ++i) {
            const Wavelength w = response.sample((static_cast<float>(i) + 0.5f) / kSamples);
            add(all, w.weight * share(w.nm));
            add(mean, response.mean(w, share));
            add(met, response.mean_over_chance(w, share) * share(w.nm));
        }
        for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_NEAR(mean[c], all[c], 5e-4);
            EXPECT_NEAR(met[c], all[c], 5e-4);
        }
    };
    compare(flat);
    compare(rising);
    compare(red);
}

TEST(DispersedIor, HasTheAbbeNumberAndNeverFallsBelowOne) {
    EXPECT_EQ(dispersed_ior(1.5f, 0.7f, 0.0f), 1.5f);
    EXPECT_EQ(dispersed_ior(1.5f, 0.0f, 400.0f), 1.5f);
    const float spread = dispersed_ior(1.5f, 20.0f / 55.0f, 486.1f) - dispersed_ior(1.5f, 20.0f / 55.0f, 656.3f);
    EXPECT_NEAR(0.5f / spread, 55.0f, 0.05f);
    EXPECT_EQ(dispersed_ior(1.01f, 1000.0f, 780.0f), 1.0f);
}

}  // namespace

}  // namespace etendue::test
