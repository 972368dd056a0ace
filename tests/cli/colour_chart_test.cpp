// A chart of known colours, rendered end to end, against what OpenColorIO's own program makes of the same numbers.
#include "core/error.h"
#include "image/read.h"
#include "image/write.h"
#include "process/run_command.h"
#include "program/run_program.h"
#include "program/small_files.h"
#include "support/aces_container.h"
#include "support/temporary_folder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace etendue::test {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kColumns = 8;
constexpr int kRows = 6;
constexpr int kPatch = 6;  // pixels on a side
constexpr const char* kRec709 = "Linear Rec.709 (sRGB)";
constexpr const char* kGamutCompression = "ACES 1.3 Reference Gamut Compression";

using Color = std::array<float, 3>;

/// Linear Rec.709: a row of greys from 2^-9 to 32, primaries and secondaries at two levels, skin, foliage, sky and
/// more.
std::vector<Color> chart_colors() {
    std::vector<Color> colors;
    for (int i = 0; i < kColumns; ++i) {
        const float grey = std::exp2(2.0f * static_cast<float>(i) - 9.0f);
        colors.push_back({grey, grey, grey});
    }
    for (const float level : {0.18f, 1.0f})
        for (int i = 1; i <= kColumns; ++i) {
            const int bits = i % kColumns;
            const auto value = [&](int bit) { return (bits >> bit & 1) != 0 ? level : 0.02f * level; };
            colors.push_back({value(0), value(1), value(2)});
        }
    colors.insert(colors.end(), {{0.173f, 0.083f, 0.056f},
                                 {0.545f, 0.300f, 0.220f},
                                 {0.109f, 0.195f, 0.333f},
                                 {0.105f, 0.150f, 0.052f},
                                 {0.230f, 0.216f, 0.436f},
                                 {0.121f, 0.512f, 0.406f},
                                 {0.685f, 0.200f, 0.024f},
                                 {0.062f, 0.104f, 0.380f}});
    colors.insert(colors.end(), {{1.0f, 0.0f, 0.0f},
                                 {0.0f, 1.0f, 0.0f},
                                 {0.0f, 0.0f, 1.0f},
                                 {4.0f, 0.5f, 0.0f},
                                 {0.0f, 3.0f, 6.0f},
                                 {8.0f, 0.2f, 7.0f},
                                 {16.0f, 12.0f, 4.0f},
                                 {0.0f, 0.0f, 0.0f}});
    for (int i = 0; i < kColumns; ++i) {
        const float t = static_cast<float>(i) / 7.0f;
        colors.push_back({0.02f + t * t, 0.4f * (1.0f - t), 0.9f * std::abs(2.0f * t - 1.0f)});
    }
    return colors;
}

/// Squares that emit the colours and reflect nothing that is seen, before an orthographic camera.
void write_chart_scene(const fs::path& directory) {
    fs::create_directories(directory);
    constexpr std::array<float, 12> kCorners = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    constexpr std::array<std::uint16_t, 6> kTriangles = {0, 1, 2, 0, 2, 3};
    write_file(directory / "square.bin",
               std::string(reinterpret_cast<const char*>(kCorners.data()), sizeof kCorners) +
                   std::string(reinterpret_cast<const char*>(kTriangles.data()), sizeof kTriangles));
    json gltf = {
        {"asset", {{"version", "2.0"}}},
        {"extensionsUsed", {"KHR_materials_emissive_strength"}},
        {"scene", 0},
        {"buffers", {{{"uri", "square.bin"}, {"byteLength", 60}}}},
        {"bufferViews", {{{"buffer", 0}, {"byteLength", 48}}, {{"buffer", 0}, {"byteOffset", 48}, {"byteLength", 12}}}},
        {"accessors",
         {{{"bufferView", 0},
           {"componentType", 5126},
           {"count", 4},
           {"type", "VEC3"},
           {"min", {0, 0, 0}},
           {"max", {1, 1, 0}}},
          {{"bufferView", 1}, {"componentType", 5123}, {"count", 6}, {"type", "SCALAR"}}}}};
    const std::vector<Color> colors = chart_colors();
    ASSERT_EQ(colors.size(), static_cast<std::size_t>(kColumns * kRows));
    json roots = json::array();
    for (std::size_t i = 0; i < colors.size(); ++i) {
        const float strength = std::max({colors[i][0], colors[i][1], colors[i][2], 1.0f});
        gltf["materials"].push_back(
            {{"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 0, 1}}}},
             {"emissiveFactor", {colors[i][0] / strength, colors[i][1] / strength, colors[i][2] / strength}},
             {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", strength}}}}}});
        gltf["meshes"].push_back(
            {{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}, {"material", i}}}}});
        gltf["nodes"].push_back(
            {{"mesh", i}, {"translation", {i % kColumns, kRows - 1 - static_cast<int>(i) / kColumns, 0}}});
        roots.push_back(i);
    }
    gltf["scenes"] = {{{"nodes", roots}}};
    write_file(directory / "scene.gltf", gltf.dump());
    const json settings = {{"size", {kColumns * kPatch, kRows * kPatch}},
                           {"spp", 1},
                           {"integrator", {{"max_depth", 1}}},
                           {"film", {{"filter", "box"}}},
                           {"environment", {{"color", {0, 0, 0}}}},
                           {"color", {{"exposure", 0}}},
                           {"camera",
                            {{"type", "orthographic"},
                             {"position", {0.5 * kColumns, 0.5 * kRows, 5}},
                             {"look_at", {0.5 * kColumns, 0.5 * kRows, 0}},
                             {"ymag", 0.5 * kRows}}}};
    write_file(directory / "render.json", settings.dump());
}

/// The project's config with views that have looks, since ocioconvert cannot be told one.
void write_config(const fs::path& file) {
    std::string text = read_file(std::string(ETENDUE_SOURCE_DIR) + "/third_party_config/ocio/config.ocio");
    const auto insert_after = [&](const std::string& where, const std::string& what) {
        const std::size_t at = text.find(where);
        ASSERT_NE(at, std::string::npos) << where;
        text.insert(at + where.size(), what);
    };
    const auto view = [](const char* name, const char* look) {
        return fmt::format(
            "    - !<View> {{name: {}, view_transform: ACES 1.0 - SDR Video, "
            "display_colorspace: sRGB - Display, looks: \"{}\"}}\n",
            name, look);
    };
    insert_after("displays:\n  sRGB - Display:\n",
                 view("Compressed", kGamutCompression) + view("Warmed", "Warm") +
                     view("Both", fmt::format("{}, Warm", kGamutCompression).c_str()));
    insert_after("active_views: [ACES 1.0 - SDR Video, Un-tone-mapped, Raw", ", Compressed, Warmed, Both");
    insert_after("looks:\n",
                 "  - !<Look> {name: Warm, process_space: ACEScct, transform: !<CDLTransform> "
                 "{slope: [1.1, 1, 0.85], offset: [0.02, 0, -0.01], power: [0.95, 1, 1.05], saturation: 1.2}}\n");
    write_file(file, text);
}

class ColourChart : public testing::Test {
  protected:
    void SetUp() override {
        try {
            (void)run_command({"ocioconvert", "--help"});
        } catch (const IoError&) {
            GTEST_SKIP() << "there is no ocioconvert (Debian: opencolorio-tools)";
        }
        write_config(folder_ / "config.ocio");
        ::setenv("OCIO", (folder_ / "config.ocio").c_str(), 1);
        write_chart_scene(folder_ / "chart");
        const std::vector<Color> colors = chart_colors();
        ImageF patches(kColumns, kRows, 3);
        for (std::size_t i = 0; i < colors.size(); ++i)
            std::ranges::copy(colors[i], patches.pixels.begin() + static_cast<std::ptrdiff_t>(3 * i));
        write_image(folder_ / "rec709.exr", patches, {.depth = PixelDepth::Float});
        (void)converted({"rec709.exr", kRec709, "acescg.exr", "ACEScg"});
    }
    void TearDown() override { ::unsetenv("OCIO"); }

    /// A pixel for each patch; the arguments name the files in the folder.
    [[nodiscard]] ImageF converted(std::vector<std::string> arguments) const {
        const bool has_view = arguments.front() == "--view";
        const std::size_t in = has_view ? 1 : 0;
        arguments[in] = folder_ / arguments[in];
        arguments[in + 2] = folder_ / arguments[in + 2];
        const fs::path out = arguments[in + 2];
        arguments.insert(arguments.begin(), "ocioconvert");
        const CommandResult result = run_command(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
        return read_image_float(out);
    }

    /// Made once for all tests of a process: the chart and the config are always the same.
    [[nodiscard]] const ImageF& shown_by_ocio(const std::string& display, const std::string& view) const {
        static std::map<std::pair<std::string, std::string>, ImageF> known;
        const auto [shown, is_new] = known.try_emplace({display, view});
        if (is_new) shown->second = converted({"--view", "acescg.exr", "ACEScg", "shown.exr", display, view});
        return shown->second;
    }

    void run(std::vector<std::string> arguments) const {
        const ProgramResult result = run_etendue(arguments, folder_.path());
        ASSERT_EQ(result.exit_code, 0) << result.err;
    }

    TestFolder folder_;
};

/// Calls `check` with each pixel of the patches that does not touch another patch, and with the patch's own.
template <typename Check>
void for_patches(const ImageF& chart, const ImageF& patches, const Check& check) {
    ASSERT_EQ(chart.width, kColumns * kPatch);
    ASSERT_EQ(chart.height, kRows * kPatch);
    for (int y = 0; y < chart.height; ++y)
        for (int x = 0; x < chart.width; ++x) {
            const bool is_edge =
                x % kPatch == 0 || y % kPatch == 0 || x % kPatch == kPatch - 1 || y % kPatch == kPatch - 1;
            if (!is_edge)
                for (std::size_t c = 0; c < 3; ++c)
                    check(chart.pixel(x, y)[c], patches.pixel(x / kPatch, y / kPatch)[c],
                          fmt::format("patch {}, {}, channel {}", x / kPatch, y / kPatch, c));
        }
}

/// Largest difference in code values of 8 bits.
int code_difference(const fs::path& png, const ImageF& expected) {
    const ImageF image = read_image_float(png);
    int largest = 0;
    for_patches(image, expected, [&](float found, float wanted, const std::string&) {
        const auto code = [](float value) {
            return static_cast<int>(std::lround(std::clamp(value, 0.0f, 1.0f) * 255.0f));
        };
        largest = std::max(largest, std::abs(code(found) - code(wanted)));
    });
    return largest;
}

struct Shown {
    const char* display;
    const char* view;
    const char* look;       ///< that etendue is told; empty for none
    const char* ocio_view;  ///< that shows the same
};

constexpr Shown kShown[] = {
    {"sRGB - Display", "ACES 1.0 - SDR Video", "", "ACES 1.0 - SDR Video"},
    {"sRGB - Display", "Un-tone-mapped", "", "Un-tone-mapped"},
    {"sRGB - Display", "Raw", "", "Raw"},
    {"Rec.1886 Rec.709 - Display", "ACES 1.0 - SDR Video", "", "ACES 1.0 - SDR Video"},
    {"Display P3 - Display", "ACES 1.0 - SDR Video", "", "ACES 1.0 - SDR Video"},
    {"Display P3 - Display", "Un-tone-mapped", "", "Un-tone-mapped"},
    {"sRGB - Display", "ACES 1.0 - SDR Video", kGamutCompression, "Compressed"},
    {"sRGB - Display", "ACES 1.0 - SDR Video", "Warm", "Warmed"},
    {"sRGB - Display", "ACES 1.0 - SDR Video", "ACES 1.3 Reference Gamut Compression, Warm", "Both"},
    {"sRGB - Display", "Warmed", "", "Warmed"},
    {"sRGB - Display", "Warmed", "none", "ACES 1.0 - SDR Video"},
    {"sRGB - Display", "Warmed", kGamutCompression, "Compressed"},
};

std::vector<std::string> view_options(const Shown& shown) {
    std::vector<std::string> options{"--display", shown.display, "--view", shown.view};
    if (*shown.look != '\0') options.insert(options.end(), {"--look", shown.look});
    return options;
}

// A display, a view that has none of its own, and a look: `view`, which takes the same ways, shows all that there are.
TEST_F(ColourChart, PreviewsAreWhatOcioconvertShows) {
    for (const Shown& shown : {kShown[0], kShown[5], kShown[8]}) {
        std::vector<std::string> arguments{"render", "chart", "-o", "chart.exr", "--quiet"};
        const auto options = view_options(shown);
        arguments.insert(arguments.end(), options.begin(), options.end());
        run(arguments);
        EXPECT_LE(code_difference(folder_ / "chart.png", shown_by_ocio(shown.display, shown.ocio_view)), 1)
            << shown.display << ", " << shown.view << ", " << shown.look;
    }
}

TEST_F(ColourChart, ViewsOfTheFileAreWhatOcioconvertShows) {
    run({"render", "chart", "-o", "chart.exr", "--quiet"});
    for (const Shown& shown : kShown) {
        std::vector<std::string> arguments{"view", "chart.exr", "-o", "view.png"};
        const auto options = view_options(shown);
        arguments.insert(arguments.end(), options.begin(), options.end());
        run(arguments);
        const ImageF expected = shown_by_ocio(shown.display, shown.ocio_view);
        EXPECT_LE(code_difference(folder_ / "view.png", expected), 1)
            << shown.display << ", " << shown.view << ", " << shown.look;
    }
}

TEST_F(ColourChart, LooksShow) {
    const ImageF plain = shown_by_ocio("sRGB - Display", "ACES 1.0 - SDR Video");
    for (const char* view : {"Compressed", "Warmed"}) {
        const ImageF graded = shown_by_ocio("sRGB - Display", view);
        float largest = 0.0f;
        for (std::size_t i = 0; i < plain.pixels.size(); ++i)
            largest = std::max(largest, std::abs(plain.pixels[i] - graded.pixels[i]));
        EXPECT_GT(largest, 0.05f) << view << ": the test would pass without looks";
    }
}

TEST_F(ColourChart, ExrsHoldTheNumbersOfEachSpace) {
    for (const char* space : {"ACEScg", "ACES2065-1", "Linear Rec.2020", kRec709}) {
        run({"render", "chart", "-o", "chart.exr", "--quiet", "--float", "--exr-space", space});
        const ImageF expected = converted({"rec709.exr", kRec709, "expected.exr", space});
        for_patches(read_image_float(folder_ / "chart.exr"), expected,
                    [&](float found, float wanted, const std::string& where) {
                        EXPECT_NEAR(found, wanted, 2e-6f + 4e-6f * std::abs(wanted)) << space << ", " << where;
                    });
        EXPECT_EQ(read_image_info(folder_ / "chart.exr").color_space, space);
        run({"view", "chart.exr", "-o", "view.png"});
        EXPECT_LE(code_difference(folder_ / "view.png", shown_by_ocio("sRGB - Display", "ACES 1.0 - SDR Video")), 1)
            << space;
    }
}

TEST_F(ColourChart, AcesContainersHoldTheNumbersOfAces) {
    run({"render", "chart", "-o", "chart.exr", "--quiet", "--aces-container"});
    EXPECT_EQ(AcesContainerCheck::violations(read_all(folder_ / "chart.exr")), std::vector<std::string>());
    const ImageF expected = converted({"rec709.exr", kRec709, "expected.exr", "ACES2065-1"});
    for_patches(read_image_float(folder_ / "chart.exr"), expected,
                [](float found, float wanted, const std::string& where) {
                    EXPECT_NEAR(found, wanted, 1e-6f + std::exp2(-11.0f) * std::abs(wanted)) << where;
                });
    run({"view", "chart.exr", "-o", "view.png"});
    EXPECT_LE(code_difference(folder_ / "view.png", shown_by_ocio("sRGB - Display", "ACES 1.0 - SDR Video")), 1);
}

}  // namespace

}  // namespace etendue::test
