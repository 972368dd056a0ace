#include "color/color_config.h"
#include "core/error.h"
#include "support/temporary_folder.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue {

namespace {

float srgb_encode(float linear) {  // IEC 61966-2-1:1999, equations 9 and 10
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

void expect_near_color(const Rgb& found, const Rgb& expected, float tolerance) {
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
        expect_near_color(srgb(color), encoded, 1e-5f);
        expect_near_color(p3(color), encoded, 1e-5f);
        const float gamma = 1.0f / 2.4f;
        expect_near_color(rec1886(color),
                          {std::pow(color.r, gamma), std::pow(color.g, gamma), std::pow(color.b, gamma)}, 2e-4f);
    }
}

TEST(DisplayTransform, ColoursKeepTheirMeaningAcrossWorkingSpaces) {
    const ColorConfig config = ColorConfig::built_in();
    const Rgb red(0.63f, 0.065f, 0.05f);
    for (const std::string& display : config.displays()) {
        for (const char* view : {"ACES 1.0 - SDR Video", "Un-tone-mapped"}) {
            SCOPED_TRACE(display + ", " + view);
            const Rgb in_acescg = config.matrix(kGltfColorSpace, "ACEScg")(red);
            expect_near_color(config.display_transform("ACEScg", display, view, 0.5f)(in_acescg),
                              config.display_transform(kGltfColorSpace, display, view, 0.5f)(red), 1e-5f);
        }
    }
}

// Expected values from OpenColorIO's own program: ocioconvert --view on a constant EXR.
TEST(DisplayTransform, AcesSdrShowsWhatOcioconvertShows) {
    const ColorConfig config = ColorConfig::built_in();
    const auto srgb = config.display_transform("ACEScg", "sRGB - Display", "ACES 1.0 - SDR Video", 0.0f);
    expect_near_color(srgb(Rgb(0.18f)), Rgb(0.355954260f), 1e-5f);
    expect_near_color(srgb(Rgb(0.8f, 0.1f, 0.05f)), Rgb(0.888207078f, 0.055859640f, 0.119313575f), 1e-5f);
    const auto rec1886 = config.display_transform("ACEScg", "Rec.1886 Rec.709 - Display", "ACES 1.0 - SDR Video", 0.0f);
    expect_near_color(rec1886(Rgb(0.18f)), Rgb(0.389530122f), 1e-5f);
}

TEST(DisplayTransform, ExposureIsInStopsBeforeTheView) {
    const ColorConfig config = ColorConfig::built_in();
    for (const char* name : {"ACES 1.0 - SDR Video", "Un-tone-mapped", "Raw"}) {
        const auto plain = config.display_transform("ACEScg", "sRGB - Display", name, 0.0f);
        const auto brighter = config.display_transform("ACEScg", "sRGB - Display", name, 1.5f);
        expect_near_color(brighter(Rgb(0.1f, 0.2f, 0.05f)), plain(Rgb(0.1f, 0.2f, 0.05f) * std::exp2(1.5f)), 1e-5f);
    }
}

constexpr const char* kCompression = "ACES 1.3 Reference Gamut Compression";
constexpr const char* kSrgb = "sRGB - Display";

/// Of a config with a view that has looks of its own: red is halved in `Half`, and doubled in `Double`.
ColorConfig config_with_looks(const std::filesystem::path& file) {
    std::ofstream(file) << R"(ocio_profile_version: 2
search_path: ""
roles: {default: linear, scene_linear: linear}
looks:
  - !<Look> {name: Half, process_space: linear, transform: !<MatrixTransform> {matrix: [0.5, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}}
  - !<Look> {name: Offset, process_space: linear, transform: !<MatrixTransform> {offset: [0, 0.25, 0, 0]}}
displays:
  s:
    - !<View> {name: plain, colorspace: linear}
    - !<View> {name: halved, colorspace: linear, looks: Half}
colorspaces:
  - !<ColorSpace> {name: linear, encoding: scene-linear}
)";
    return ColorConfig::from_file(file);
}

TEST(DisplayTransform, ALookTakesThePlaceOfTheViewsOwn) {
    const TemporaryFolder folder;
    const ColorConfig config = config_with_looks(folder / "config.ocio");
    const Rgb color(0.5f, 0.25f, 0.125f);
    const auto shown = [&](const char* view, const char* look, float exposure = 0.0f) {
        return config.display_transform("linear", "s", view, exposure, look)(color);
    };
    EXPECT_EQ(shown("plain", ""), color);
    EXPECT_EQ(shown("plain", "Half"), Rgb(0.25f, 0.25f, 0.125f));
    EXPECT_EQ(shown("halved", ""), Rgb(0.25f, 0.25f, 0.125f));
    EXPECT_EQ(shown("halved", "none"), color);
    EXPECT_EQ(shown("halved", "Half"), Rgb(0.25f, 0.25f, 0.125f)) << "once, not twice";
    EXPECT_EQ(shown("halved", "Offset"), Rgb(0.5f, 0.5f, 0.125f));
    EXPECT_EQ(shown("plain", "Half, Offset"), Rgb(0.25f, 0.5f, 0.125f));
    EXPECT_EQ(shown("plain", "-Half"), Rgb(1.0f, 0.25f, 0.125f)) << "undone";
    EXPECT_EQ(shown("plain", "Offset", 1.0f), Rgb(1.0f, 0.75f, 0.25f)) << "exposure comes first";
    EXPECT_EQ(config.looks(), (std::vector<std::string>{"Half", "Offset"}));
    EXPECT_EQ(config.looks_of_view("s", "halved"), "Half");
    EXPECT_EQ(config.looks_of_view("s", "plain"), "");
}

TEST(DisplayTransform, TheAcademysCompressionBringsColoursIntoAp1) {
    const ColorConfig config = ColorConfig::built_in();
    const auto raw = config.display_transform("ACEScg", kSrgb, "Raw", 0.0f, kCompression);
    const Rgb grey = raw(Rgb(0.18f));
    expect_near_color(grey, Rgb(0.18f), 1e-5f);
    const Rgb saturated = raw(Rgb(0.5f, -0.05f, 0.2f));
    EXPECT_GT(saturated.g, 0.0f);
    EXPECT_LT(saturated.g, 0.1f);
}

TEST(DisplayTransform, UnknownNamesAreToldWithAllThereAre) {
    const ColorConfig config = ColorConfig::built_in();
    const auto error_of = [&](const char* display, const char* view, const char* look) -> std::string {
        try {
            (void)config.display_transform("ACEScg", display, view, 0.0f, look);
        } catch (const SceneError& error) {
            return error.what();
        }
        return "none";
    };
    const auto expect_named = [](const std::string& text, const std::vector<std::string>& names) {
        for (const std::string& name : names) EXPECT_NE(text.find(name), std::string::npos) << name << " in " << text;
    };
    expect_named(
        error_of("sRGB", "Raw", ""),
        {"there is no display 'sRGB'", "'sRGB - Display', 'Rec.1886 Rec.709 - Display'", "'Display P3 - Display'"});
    expect_named(error_of(kSrgb, "ACES", ""),
                 {"view of display 'sRGB - Display' called 'ACES'", "'ACES 1.0 - SDR Video', 'Un-tone-mapped', 'Raw'"});
    expect_named(error_of(kSrgb, "Raw", "Warm"), {"there is no look 'Warm'", kCompression});
    expect_named(error_of(kSrgb, "Raw", "ACES 1.3 Reference Gamut Compression, -Warm"), {"there is no look 'Warm'"});
    expect_named(error_of(kSrgb, "Raw", "+"), {"there is no look ''"});
    EXPECT_EQ(error_of(kSrgb, "Raw", "none"), "none");
}

TEST(DisplayTransform, RawShowsTheNumbers) {
    const auto raw = ColorConfig::built_in().display_transform("ACEScg", "sRGB - Display", "Raw", 0.0f);
    expect_near_color(raw(Rgb(0.1f, 0.2f, 3.0f)), Rgb(0.1f, 0.2f, 3.0f), 0.0f);
}

}  // namespace

}  // namespace etendue
