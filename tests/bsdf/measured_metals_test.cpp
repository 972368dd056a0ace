#include "bsdf/measured_metals.h"

#include "bsdf/fresnel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace etendue {

namespace {

struct Published {
    std::string_view symbol;
    Rgb value;
    float tolerance;
};

float largest_difference(const Rgb& a, const Rgb& b) {
    return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

std::string text(const Rgb& c) {
    return std::string("(").append(std::to_string(c.r)) + ", " + std::to_string(c.g) + ", " + std::to_string(c.b) + ")";
}

// Linear Rec.709 reflectances at normal incidence, computed by others. Lagarde: "Feeding a physically based shading
// model", 2011. Adobe: metal material references of the Adobe Standard Material. PBDB: an earlier edition of the
// Physically Based Database. Where the tolerance is wide, the other author started from another sample.
TEST(MeasuredMetals, ReflectanceAtNormalIncidenceIsAsPublished) {
    const std::array<Published, 11> known{{
        {"Ag", {0.9868f, 0.9830f, 0.9667f}, 0.015f},  // Adobe
        {"Al", {0.913f, 0.921f, 0.925f}, 0.015f},     // Lagarde
        {"Al", {0.9157f, 0.9226f, 0.9236f}, 0.015f},  // Adobe
        {"Au", {1.000f, 0.766f, 0.336f}, 0.04f},      // Lagarde
        {"Au", {1.0000f, 0.7099f, 0.3148f}, 0.055f},  // Adobe
        {"Cr", {0.550f, 0.556f, 0.554f}, 0.002f},     // Lagarde
        {"Cr", {0.5496f, 0.5561f, 0.5531f}, 0.002f},  // Adobe
        {"Cu", {0.955f, 0.637f, 0.538f}, 0.03f},      // Lagarde
        {"Fe", {0.531f, 0.512f, 0.496f}, 0.005f},     // PBDB
        {"Ti", {0.616f, 0.582f, 0.544f}, 0.005f},     // PBDB
        {"W", {0.504f, 0.498f, 0.478f}, 0.015f},      // PBDB
    }};
    for (const Published& metal : known) {
        SCOPED_TRACE(metal.symbol);
        const auto measured = measured_metal(metal.symbol);
        ASSERT_TRUE(measured);
        EXPECT_LT(largest_difference(measured->f0, metal.value), metal.tolerance) << text(measured->f0);
    }
}

// Adobe publishes reflectance at cos theta = 1/7 relative to Schlick's curve.
TEST(MeasuredMetals, ReflectanceAt82DegreesIsAsPublished) {
    const std::array<Published, 3> known{{{"Ag", {0.9929f, 0.9961f, 1.0000f}, 0.005f},
                                          {"Cr", {0.7372f, 0.7511f, 0.8170f}, 0.005f},
                                          {"Cu", {0.9755f, 0.9349f, 0.9301f}, 0.02f}}};
    for (const Published& metal : known) {
        SCOPED_TRACE(metal.symbol);
        const auto measured = measured_metal(metal.symbol);
        ASSERT_TRUE(measured);
        const Rgb relative = measured->f82 / fresnel_schlick(measured->f0, 1.0f / 7.0f);
        EXPECT_LT(largest_difference(relative, metal.value), metal.tolerance) << text(relative);
    }
}

TEST(MeasuredMetals, FollowsTheExactReflectance) {
    for (const std::string_view symbol : measured_metal_names()) {
        SCOPED_TRACE(symbol);
        const MetalReflectance metal = *measured_metal(symbol);
        EXPECT_EQ(metal.f0, *measured_metal_reflectance(symbol, 1.0));
        EXPECT_EQ(metal.f82, *measured_metal_reflectance(symbol, 1.0 / 7.0));
        EXPECT_LT(largest_difference(*measured_metal_reflectance(symbol, 0.0), Rgb(1.0f)), 1e-6f);
    }
}

// What a lobe gets from two numbers against spectral integration at every angle. The curve is worst near grazing
// incidence, where little light is reflected: 0.033 for tungsten; over the hemisphere it errs by less than 0.01.
TEST(MeasuredMetals, FittedCurveStaysCloseToSpectralIntegration) {
    constexpr int kSteps = 200;
    for (const std::string_view symbol : measured_metal_names()) {
        SCOPED_TRACE(symbol);
        const MetalReflectance metal = *measured_metal(symbol);
        const FresnelMetal curve = FresnelMetal::from_f0_f82(metal.f0, metal.f82);
        float worst = 0.0f;
        Rgb exact_average, curve_average;
        for (int i = 0; i < kSteps; ++i) {
            const float cos_i = (static_cast<float>(i) + 0.5f) / kSteps;
            const Rgb exact = *measured_metal_reflectance(symbol, cos_i);
            worst = std::max(worst, largest_difference(curve(cos_i), exact));
            exact_average += exact * (2.0f * cos_i / kSteps);
            curve_average += curve(cos_i) * (2.0f * cos_i / kSteps);
        }
        RecordProperty(std::string("worst_").append(symbol), std::to_string(worst));
        EXPECT_LT(worst, 0.035f);
        EXPECT_LT(largest_difference(curve_average, exact_average), 0.01f);
        EXPECT_LT(largest_difference(curve.average(), exact_average), 0.01f);
    }
}

TEST(MeasuredMetals, StayWithinZeroAndOne) {
    for (const std::string_view symbol : measured_metal_names()) {
        SCOPED_TRACE(symbol);
        for (int i = 0; i <= 20; ++i) {
            const Rgb reflectance = *measured_metal_reflectance(symbol, i / 20.0);
            EXPECT_GT(min_component(reflectance), 0.0f);
            EXPECT_LE(max_component(reflectance), 1.0f);
        }
    }
}

TEST(MeasuredMetals, KnowsItsNamesAndNoOthers) {
    const std::vector<std::string_view> expected{"Ag", "Al", "Au", "Cr", "Cu", "Fe", "Ti", "W"};
    EXPECT_TRUE(std::ranges::equal(measured_metal_names(), expected));
    for (const std::string_view symbol : {"", "A", "ag", "Gold", "Au ", "Zn"}) {
        EXPECT_FALSE(measured_metal(symbol)) << symbol;
        EXPECT_FALSE(measured_metal_reflectance(symbol, 1.0)) << symbol;
    }
}

}  // namespace

}  // namespace etendue
