#include "color/color_config.h"

#include <cmath>

#include <gtest/gtest.h>

namespace etendue {

namespace {

float srgb_encode(float linear) {  // IEC 61966-2-1:1999, equations 9 and 10
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

void expect_near(const Rgb& found, const Rgb& expected, float tolerance) {
    EXPECT_NEAR(found.r, expected.r, tolerance);
    EXPECT_NEAR(found.g, expected.g, tolerance);
    EXPECT_NEAR(found.b, expected.b, tolerance);
}

TEST(DisplayTransform, UnToneMappedIsTheCurveOfTheDisplay) {
    const ColorConfig config = ColorConfig::built_in();
    const auto srgb = config.display_transform("Linear Rec.709 (sRGB)", "sRGB - Display", "Un-tone-mapped", 0.0f);
    const auto rec1886 =
        config.display_transform("Linear Rec.709 (sRGB)", "Rec.1886 Rec.709 - Display", "Un-tone-mapped", 0.0f);
    const auto p3 = config.display_transform("Linear P3-D65", "Display P3 - Display", "Un-tone-mapped", 0.0f);
    for (const Rgb& color : {Rgb(0.0f), Rgb(0.18f), Rgb(0.001f, 0.5f, 0.9f), Rgb(1.0f)}) {
        const Rgb encoded(srgb_encode(color.r), srgb_encode(color.g), srgb_encode(color.b));
        expect_near(srgb(color), encoded, 1e-5f);
        expect_near(p3(color), encoded, 1e-5f);
        const float gamma = 1.0f / 2.4f;
        expect_near(rec1886(color), {std::pow(color.r, gamma), std::pow(color.g, gamma), std::pow(color.b, gamma)},
                    2e-4f);
    }
}

TEST(DisplayTransform, ColoursKeepTheirMeaningAcrossWorkingSpaces) {
    const ColorConfig config = ColorConfig::built_in();
    const Rgb red(0.63f, 0.065f, 0.05f);
    for (const std::string& display : config.displays()) {
        for (const char* view : {"ACES 1.0 - SDR Video", "Un-tone-mapped"}) {
            SCOPED_TRACE(display + ", " + view);
            const Rgb in_acescg = config.matrix(kGltfColorSpace, "ACEScg")(red);
            expect_near(config.display_transform("ACEScg", display, view, 0.5f)(in_acescg),
                        config.display_transform(kGltfColorSpace, display, view, 0.5f)(red), 1e-5f);
        }
    }
}

// Expected values from OpenColorIO's own program: ocioconvert --view on a constant EXR.
TEST(DisplayTransform, AcesSdrShowsWhatOcioconvertShows) {
    const ColorConfig config = ColorConfig::built_in();
    const auto srgb = config.display_transform("ACEScg", "sRGB - Display", "ACES 1.0 - SDR Video", 0.0f);
    expect_near(srgb(Rgb(0.18f)), Rgb(0.355954260f), 1e-5f);
    expect_near(srgb(Rgb(0.8f, 0.1f, 0.05f)), Rgb(0.888207078f, 0.055859640f, 0.119313575f), 1e-5f);
    const auto rec1886 = config.display_transform("ACEScg", "Rec.1886 Rec.709 - Display", "ACES 1.0 - SDR Video", 0.0f);
    expect_near(rec1886(Rgb(0.18f)), Rgb(0.389530122f), 1e-5f);
}

TEST(DisplayTransform, ExposureIsInStopsBeforeTheView) {
    const ColorConfig config = ColorConfig::built_in();
    for (const char* name : {"ACES 1.0 - SDR Video", "Un-tone-mapped", "Raw"}) {
        const auto plain = config.display_transform("ACEScg", "sRGB - Display", name, 0.0f);
        const auto brighter = config.display_transform("ACEScg", "sRGB - Display", name, 1.5f);
        expect_near(brighter(Rgb(0.1f, 0.2f, 0.05f)), plain(Rgb(0.1f, 0.2f, 0.05f) * std::exp2(1.5f)), 1e-5f);
    }
}

TEST(DisplayTransform, RawShowsTheNumbers) {
    const auto raw = ColorConfig::built_in().display_transform("ACEScg", "sRGB - Display", "Raw", 0.0f);
    expect_near(raw(Rgb(0.1f, 0.2f, 3.0f)), Rgb(0.1f, 0.2f, 3.0f), 0.0f);
}

}  // namespace

}  // namespace etendue
