#include "color/color_config.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

namespace etendue {

namespace {

constexpr const char* kOwnConfig = ETENDUE_SOURCE_DIR "/third_party_config/ocio/config.ocio";

// $OCIO for the length of a test.
class OcioVariable {
  public:
    explicit OcioVariable(const std::string& value) { ::setenv("OCIO", value.c_str(), 1); }
    ~OcioVariable() { ::unsetenv("OCIO"); }
    OcioVariable(const OcioVariable&) = delete;
    OcioVariable& operator=(const OcioVariable&) = delete;
};

void expect_near(const ColorMatrix& found, const std::array<float, 9>& expected, float tolerance) {
    for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(found.m[i], expected[i], tolerance) << "element " << i;
}

void expect_near(const Rgb& found, const Rgb& expected, float tolerance) {
    EXPECT_NEAR(found.r, expected.r, tolerance);
    EXPECT_NEAR(found.g, expected.g, tolerance);
    EXPECT_NEAR(found.b, expected.b, tolerance);
}

std::string error_of(const auto& action) {
    try {
        action();
    } catch (const SceneError& error) {
        return error.what();
    }
    return "";
}

TEST(ColorConfig, NamesAreThoseOfThePublicConfig) {
    const ColorConfig config = ColorConfig::built_in();
    EXPECT_EQ(config.origin(), "built-in");
    EXPECT_EQ(config.default_working_space(), "ACEScg");
    const auto spaces = config.spaces();
    for (const char* name : {"ACEScg", "ACES2065-1", "Linear Rec.709 (sRGB)", "Linear Rec.2020", "sRGB - Texture",
                             "Gamma 2.2 Rec.709 - Texture", "Raw"}) {
        EXPECT_NE(std::find(spaces.begin(), spaces.end(), name), spaces.end()) << name;
    }
    EXPECT_EQ(config.displays(),
              (std::vector<std::string>{"sRGB - Display", "Rec.1886 Rec.709 - Display", "Display P3 - Display"}));
    EXPECT_EQ(config.default_display(), "sRGB - Display");
    for (const std::string& display : config.displays()) {
        EXPECT_EQ(config.views(display), (std::vector<std::string>{"ACES 1.0 - SDR Video", "Un-tone-mapped", "Raw"}));
        EXPECT_EQ(config.default_view(display), "ACES 1.0 - SDR Video");
    }
}

TEST(ColorConfig, ResolvesAliasesAndRoles) {
    const ColorConfig config = ColorConfig::built_in();
    EXPECT_EQ(config.resolve_space("lin_rec709"), "Linear Rec.709 (sRGB)");
    EXPECT_EQ(config.resolve_space("acescg"), "ACEScg");
    EXPECT_EQ(config.resolve_space("scene_linear"), "ACEScg");
    EXPECT_EQ(config.resolve_space("srgb_tx"), "sRGB - Texture");
    EXPECT_EQ(config.resolve_space("data"), "Raw");
    EXPECT_EQ(config.resolve_space(kGltfColorSpace), kGltfColorSpace);
}

TEST(ColorConfig, UnknownNamesSuggestTheNearest) {
    const ColorConfig config = ColorConfig::built_in();
    const std::string space = error_of([&] { (void)config.resolve_space("ACESgc"); });
    EXPECT_NE(space.find("'ACESgc'"), std::string::npos) << space;
    EXPECT_NE(space.find("did you mean 'ACEScg'"), std::string::npos) << space;
    const std::string alias = error_of([&] { (void)config.transform("lin_rec708", "ACEScg"); });
    EXPECT_NE(alias.find("did you mean 'lin_rec709'"), std::string::npos) << alias;
    const std::string display = error_of([&] { (void)config.views("sRGB - Disply"); });
    EXPECT_NE(display.find("did you mean 'sRGB - Display'"), std::string::npos) << display;
    const std::string view =
        error_of([&] { (void)config.display_transform("ACEScg", "sRGB - Display", "Un-tone-maped", 0.0f); });
    EXPECT_NE(view.find("did you mean 'Un-tone-mapped'"), std::string::npos) << view;
    EXPECT_THROW((void)config.default_view("none"), SceneError);
}

// AMPAS, ACES 1.3 reference transforms and ITU-R BT.2087; the numbers follow from the published primaries.
TEST(ColorConfig, MatricesAreThePublishedOnes) {
    const ColorConfig config = ColorConfig::built_in();
    expect_near(
        config.matrix("Linear Rec.709 (sRGB)", "ACEScg"),
        {0.6130974f, 0.3395231f, 0.0473795f, 0.0701937f, 0.9163539f, 0.0134524f, 0.0206156f, 0.1095698f, 0.8698146f},
        2e-6f);
    expect_near(config.matrix("ACEScg", "Linear Rec.709 (sRGB)"),
                {1.7050510f, -0.6217921f, -0.0832589f, -0.1302564f, 1.1408047f, -0.0105483f, -0.0240034f, -0.1289690f,
                 1.1529723f},
                2e-6f);
    expect_near(
        config.matrix("ACEScg", "ACES2065-1"),
        {0.6954522f, 0.1406787f, 0.1638691f, 0.0447946f, 0.8596711f, 0.0955343f, -0.0055259f, 0.0040252f, 1.0015007f},
        2e-6f);
    expect_near(
        config.matrix("Linear Rec.709 (sRGB)", "Linear Rec.2020"),
        {0.6274039f, 0.3292830f, 0.0433131f, 0.0690973f, 0.9195404f, 0.0113623f, 0.0163914f, 0.0880133f, 0.8955953f},
        2e-6f);
    expect_near(
        config.matrix("Linear Rec.709 (sRGB)", "CIE XYZ-D65 - Scene-referred"),
        {0.4123908f, 0.3575843f, 0.1804808f, 0.2126390f, 0.7151687f, 0.0721923f, 0.0193308f, 0.1191948f, 0.9505322f},
        2e-6f);
    expect_near(config.matrix("Linear P3-D65", "Linear Rec.709 (sRGB)"),
                {1.2249402f, -0.2249402f, 0.0f, -0.0420570f, 1.0420570f, 0.0f, -0.0196376f, -0.0786361f, 1.0982736f},
                2e-6f);
}

TEST(ColorConfig, MatrixAndTransformAgree) {
    const ColorConfig config = ColorConfig::built_in();
    const Rgb color(0.7f, 0.2f, 12.0f);
    const Rgb by_matrix = config.matrix("Linear Rec.709 (sRGB)", "ACEScg")(color);
    expect_near(config.transform("Linear Rec.709 (sRGB)", "ACEScg")(color), by_matrix, 1e-5f);
    expect_near(config.matrix("ACEScg", "Linear Rec.709 (sRGB)")(by_matrix), color, 1e-5f);
}

TEST(ColorConfig, EverySpaceGoesThereAndBack) {
    const ColorConfig config = ColorConfig::built_in();
    for (const std::string& space : config.spaces()) {
        const ColorTransform there = config.transform("ACEScg", space);
        const ColorTransform back = config.transform(space, "ACEScg");
        for (const Rgb& color : {Rgb(0.18f), Rgb(0.9f, 0.3f, 0.2f), Rgb(0.01f, 0.5f, 0.04f), Rgb(1.0f)}) {
            SCOPED_TRACE(space);
            expect_near(back(there(color)), color, 2e-5f);
        }
    }
}

TEST(ColorConfig, TexturesAreDecodedWithTheSrgbCurve) {
    const ColorConfig config = ColorConfig::built_in();
    const ColorTransform decode = config.transform("sRGB - Texture", "Linear Rec.709 (sRGB)");
    for (int code = 0; code <= 255; ++code) {
        const float value = static_cast<float>(code) / 255.0f;
        // IEC 61966-2-1:1999, equations 5 and 6.
        const float linear = value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
        expect_near(decode(Rgb(value)), Rgb(linear), 2e-6f);
    }
    const ColorTransform gamma = config.transform("Gamma 2.2 Rec.709 - Texture", "Linear Rec.709 (sRGB)");
    expect_near(gamma(Rgb(0.5f)), Rgb(std::pow(0.5f, 2.2f)), 1e-6f);
}

TEST(ColorConfig, DataIsNotTouchedAndIsNoLinearSpace) {
    const ColorConfig config = ColorConfig::built_in();
    expect_near(config.transform("Raw", "ACEScg")(Rgb(0.1f, 0.2f, 0.3f)), Rgb(0.1f, 0.2f, 0.3f), 0.0f);
    EXPECT_THROW((void)config.matrix("Raw", "ACEScg"), SceneError);
}

TEST(ColorConfig, CurvesAreNotLinear) {
    const ColorConfig config = ColorConfig::built_in();
    EXPECT_THROW((void)config.matrix("sRGB - Texture", "ACEScg"), SceneError);
    EXPECT_THROW((void)config.matrix("sRGB - Texture", "sRGB - Texture"), SceneError) << "though it is the identity";
    EXPECT_THROW((void)config.chromaticities("ACEScct"), SceneError);
    EXPECT_THROW((void)config.luminance_weights("sRGB - Texture"), SceneError);
}

TEST(ColorTransform, KeepsAlphaAndTakesThreeOrFourChannels) {
    const ColorConfig config = ColorConfig::built_in();
    const ColorTransform transform = config.transform("sRGB - Texture", "ACEScg");
    std::vector<float> rgba{0.5f, 0.25f, 0.75f, 0.3f, 0.1f, 0.9f, 0.4f, 1.7f};
    std::vector<float> rgb{0.5f, 0.25f, 0.75f, 0.1f, 0.9f, 0.4f};
    transform.apply(rgba, 4);
    transform.apply(rgb, 3);
    const Rgb first = transform(Rgb(0.5f, 0.25f, 0.75f));
    EXPECT_EQ(rgba[3], 0.3f);
    EXPECT_EQ(rgba[7], 1.7f);
    expect_near({rgba[0], rgba[1], rgba[2]}, first, 1e-6f);
    expect_near({rgb[0], rgb[1], rgb[2]}, first, 1e-6f);
    expect_near(Rgb(rgb[3], rgb[4], rgb[5]), Rgb{rgba[4], rgba[5], rgba[6]}, 1e-6f);
}

TEST(ColorTransform, DefaultIsTheIdentity) {
    EXPECT_EQ(ColorTransform()(Rgb(1.0f, 2.0f, 3.0f)), Rgb(1.0f, 2.0f, 3.0f));
    std::vector<float> pixels{1.0f, 2.0f, 3.0f};
    ColorTransform().apply(pixels, 3);
    EXPECT_EQ(pixels, (std::vector<float>{1.0f, 2.0f, 3.0f}));
}

TEST(ColorConfig, ChromaticitiesAreThePublishedOnesWithTheSpacesOwnWhite) {
    const ColorConfig config = ColorConfig::built_in();
    const Chromaticities acescg = config.chromaticities("ACEScg");
    EXPECT_EQ(acescg.red, (std::array<float, 2>{0.713f, 0.293f}));
    EXPECT_EQ(acescg.green, (std::array<float, 2>{0.165f, 0.830f}));
    EXPECT_EQ(acescg.blue, (std::array<float, 2>{0.128f, 0.044f}));
    EXPECT_EQ(acescg.white, (std::array<float, 2>{0.32168f, 0.33767f}));
    const Chromaticities rec709 = config.chromaticities("Linear Rec.709 (sRGB)");
    EXPECT_EQ(rec709.red, (std::array<float, 2>{0.64f, 0.33f}));
    EXPECT_EQ(rec709.white, (std::array<float, 2>{0.3127f, 0.3290f}));
    EXPECT_EQ(config.chromaticities("Linear Rec.2020").green, (std::array<float, 2>{0.170f, 0.797f}));
    EXPECT_EQ(config.chromaticities("Linear P3-D65").blue, (std::array<float, 2>{0.150f, 0.060f}));
    EXPECT_EQ(config.chromaticities("ACES2065-1").blue, (std::array<float, 2>{0.0001f, -0.077f}));
}

TEST(ColorConfig, ChromaticitiesOfUnpublishedSpacesAreComputed) {
    const Chromaticities xyz = ColorConfig::built_in().chromaticities("CIE XYZ-D65 - Scene-referred");
    EXPECT_NEAR(xyz.red[0], 1.0f, 1e-5f);
    EXPECT_NEAR(xyz.green[1], 1.0f, 1e-5f);
    EXPECT_NEAR(xyz.blue[0], 0.0f, 1e-5f);
    EXPECT_NEAR(xyz.white[0], 1.0f / 3.0f, 1e-5f);
}

TEST(ColorConfig, LuminanceWeights) {
    const ColorConfig config = ColorConfig::built_in();
    expect_near(config.luminance_weights("ACEScg"), {0.2722287f, 0.6740818f, 0.0536895f}, 1e-6f);
    expect_near(config.luminance_weights("Linear Rec.709 (sRGB)"), {0.2126390f, 0.7151687f, 0.0721923f}, 1e-6f);
    expect_near(config.luminance_weights("CIE XYZ-D65 - Scene-referred"), {0.0f, 1.0f, 0.0f}, 1e-5f);
}

TEST(ColorConfig, EnvironmentVariableOverridesTheBuiltIn) {
    ::unsetenv("OCIO");
    EXPECT_EQ(ColorConfig::from_environment().origin(), "built-in");
    {
        const OcioVariable empty("");
        EXPECT_EQ(ColorConfig::from_environment().origin(), "built-in");
    }
    const OcioVariable own(kOwnConfig);
    EXPECT_EQ(ColorConfig::from_environment().origin(), kOwnConfig);
}

TEST(ColorConfig, UnreadableConfigIsAnErrorThatNamesTheFile) {
    const OcioVariable missing("/no/such/config.ocio");
    const std::string message = error_of([] { (void)ColorConfig::from_environment(); });
    EXPECT_NE(message.find("/no/such/config.ocio"), std::string::npos) << message;
    EXPECT_THROW((void)ColorConfig::from_file(ETENDUE_SOURCE_DIR "/CMakeLists.txt"), SceneError);
}

TEST(ColorConfig, ConfigsOfVersionOneWork) {
    const auto path = std::filesystem::temp_directory_path() / ("etendue-v1-" + std::to_string(::getpid()) + ".ocio");
    std::ofstream(path) << "ocio_profile_version: 1\n"
                           "search_path: \"\"\n"
                           "luma: [0.2, 0.7, 0.1]\n"
                           "roles: {default: linear, scene_linear: linear}\n"
                           "displays:\n  screen:\n    - !<View> {name: plain, colorspace: linear}\n"
                           "colorspaces:\n  - !<ColorSpace>\n    name: linear\n";
    const ColorConfig config = ColorConfig::from_file(path);
    std::filesystem::remove(path);
    EXPECT_EQ(config.default_working_space(), "linear");
    expect_near(config.luminance_weights("linear"), {0.2f, 0.7f, 0.1f}, 1e-6f);
    EXPECT_THROW((void)config.chromaticities("linear"), SceneError);
    EXPECT_NE(error_of([&] { (void)config.resolve_space(kGltfColorSpace); }), "");
}

}  // namespace

}  // namespace etendue
