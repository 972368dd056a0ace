// Layers from the command line to the file, and past checkpoints and parts.
#include "image/layers.h"

#include "image/read_channels.h"
#include "program/run_program.h"
#include "program/small_files.h"
#include "support/temporary_folder.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace etendue::test {

namespace {

namespace fs = std::filesystem;
using Arguments = std::vector<std::string>;

class Layers : public testing::Test {
  protected:
    void SetUp() override {
        fs::create_directories(work_);
        write_scene(folder_ / "box");
    }
    [[nodiscard]] ProgramResult render(const std::string& output, const Arguments& more) const {
        Arguments arguments{"render", (folder_ / "box").string(), "--size", "16x12", "--float", "--quiet", "-o",
                            output};
        arguments.insert(arguments.end(), more.begin(), more.end());
        if (std::ranges::find(more, "--spp") == more.end()) arguments.insert(arguments.end(), {"--spp", "4"});
        return run_etendue(arguments, work_);
    }

    [[nodiscard]] std::vector<std::string> channels(const std::string& file) const {
        std::vector<std::string> names = read_channels(work_ / file).channel_names;
        std::ranges::sort(names);
        return names;
    }

    TestFolder folder_;
    fs::path work_ = folder_ / "work";
};

TEST_F(Layers, StandWhereTheyAreToStand) {
    const Arguments layers{"--aov", "depth", "--aov", "N", "--aov", "key=lpe:C D L"};
    const auto render_as = [&](const std::string& output, const std::string& layout) {
        Arguments more = layers;
        more.insert(more.end(), {"--aov-layout", layout});
        const ProgramResult result = render(output, more);
        EXPECT_EQ(result.exit_code, 0) << result.err;
    };
    render_as("a.exr", "layers");
    EXPECT_EQ(channels("a.exr"), (std::vector<std::string>{"A", "B", "G", "N.X", "N.Y", "N.Z", "R", "depth.Z", "key.B",
                                                           "key.G", "key.R"}));
    render_as("b.exr", "parts");
    const LayeredImage parts = read_layers(work_ / "b.exr");
    ASSERT_EQ(parts.parts.size(), 4u);
    EXPECT_TRUE(find_layer(parts, "N.N") || find_layer(parts, "N"));
    render_as("c.exr", "files");
    EXPECT_EQ(channels("c.exr"), (std::vector<std::string>{"A", "B", "G", "R"}));
    EXPECT_EQ(channels("c.depth.exr"), (std::vector<std::string>{"Z"}));
    EXPECT_EQ(channels("c.N.exr"), (std::vector<std::string>{"X", "Y", "Z"}));
    EXPECT_EQ(channels("c.key.exr"), (std::vector<std::string>{"B", "G", "R"}));
}

// Two lamps of one colour each, the sky, and an object that does not shine.
TEST_F(Layers, OfNumbersComeWithTheNamesOfTheirFile) {
    const ProgramResult result =
        render("a.exr", {"--aov", "object_id", "--aov", "surface=material_id", "--aov", "mist"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const ChannelImage image = read_channels(work_ / "a.exr");
    const auto names = [&](const char* layer) {
        const ImageAttribute* const found = image.find(std::string("etendue:names/") + layer);
        return found != nullptr ? std::get<std::string>(found->value) : std::string("none");
    };
    EXPECT_TRUE(names("object_id").starts_with("[\"")) << names("object_id");
    EXPECT_TRUE(names("surface").starts_with("[\"")) << names("surface");
    EXPECT_EQ(names("mist"), "none");
    const auto mist = std::ranges::find(image.channel_names, "mist.Z") - image.channel_names.begin();
    const std::size_t channels = image.channel_names.size();
    for (std::size_t p = static_cast<std::size_t>(mist); p < image.pixels.pixels.size(); p += channels) {
        EXPECT_GE(image.pixels.pixels[p], 0.0f);
        EXPECT_LE(image.pixels.pixels[p], 1.0f);
    }
}

TEST_F(Layers, OfLightsHaveTheLightOfEachAndAddUpToTheImage) {
    const fs::path file = folder_ / "box" / "scene.gltf";
    std::string scene = read_file(file);
    const auto replace = [&scene](const std::string& from, const std::string& to) {
        scene.replace(scene.find(from), from.size(), to);
    };
    replace(R"("asset": {"version": "2.0"},)",
            R"("asset": {"version": "2.0"}, "extensionsUsed": ["KHR_lights_punctual"],
  "extensions": {"KHR_lights_punctual": {"lights": [
      {"name": "key light", "type": "directional", "color": [1, 0, 0], "intensity": 900},
      {"name": "* light", "type": "directional", "color": [0, 0, 1], "intensity": 500}]}},)");
    replace(R"("nodes": [0, 1]}])", R"("nodes": [0, 1, 2, 3]}])");
    replace(R"({"name": "main", "camera": 0}])", R"({"name": "Stand", "camera": 0},
            {"name": "Key object", "extensions": {"KHR_lights_punctual": {"light": 0}}},
            {"name": "* light", "extensions": {"KHR_lights_punctual": {"light": 1}}}])");
    write_file(file, scene);
    const ProgramResult result = render("a.exr", {"--aov", "lights", "--aov", "warm=light:k*", "--aov",
                                                  "object=light:Key object", "--working-space", "lin_rec709"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const nlohmann::json inspected =
        nlohmann::json::parse(run_etendue({"inspect", (folder_ / "box").string(), "--json"}, work_).out);
    EXPECT_EQ(inspected.at("lights"), nlohmann::json::array({"key light", "* light"}));
    EXPECT_EQ(inspected.at("light_nodes"), nlohmann::json::array({"Key object", "* light"}));
    EXPECT_EQ(inspected.at("cameras"), nlohmann::json::array({"main"}));
    EXPECT_EQ(inspected.at("camera_nodes"), nlohmann::json::array({"Stand"}));
    const LayeredImage layered = read_layers(work_ / "a.exr");
    const auto layer = [&](const std::string& name) {
        const auto found = find_layer(layered, name);
        EXPECT_TRUE(found) << name;
        return found ? read_layer(work_ / "a.exr", *found) : ImageF();
    };
    const ImageF image = read_layer(work_ / "a.exr", *main_layer(layered));
    const ImageF key = layer("light_key_light");
    const ImageF rim = layer("light___light");
    const ImageF sky = layer("light_environment");
    const ImageF warm = layer("warm");
    const ImageF object = layer("object");
    ASSERT_FALSE(HasFailure());
    double reds = 0.0;
    double blues = 0.0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            for (std::size_t c = 0; c < 3; ++c) {
                const float sum = key.pixel(x, y)[c] + rim.pixel(x, y)[c] + sky.pixel(x, y)[c];
                EXPECT_NEAR(sum, image.pixel(x, y)[c], 1e-5f * (1.0f + std::abs(sum)));
                EXPECT_EQ(warm.pixel(x, y)[c], key.pixel(x, y)[c]);
                EXPECT_EQ(object.pixel(x, y)[c], key.pixel(x, y)[c]) << "by the name of its node";
            }
            EXPECT_EQ(key.pixel(x, y)[2], 0.0f);
            EXPECT_EQ(rim.pixel(x, y)[0], 0.0f);
            reds += static_cast<double>(key.pixel(x, y)[0]);
            blues += static_cast<double>(rim.pixel(x, y)[2]);
        }
    EXPECT_GT(reds, 0.0);
    EXPECT_GT(blues, 0.0);
}

// The data window has the pixels, the display window the image.
TEST_F(Layers, WindowsTellOfOverscan) {
    const std::vector<Arguments> ways{{"--crop", "-8,-8,24,20"}, {"--overscan", "8"}};
    for (const Arguments& way : ways) {
        const ProgramResult result = render("a.exr", way);
        ASSERT_EQ(result.exit_code, 0) << way.front() << ": " << result.err;
        const ChannelImage image = read_channels(work_ / "a.exr");
        EXPECT_EQ(image.data_window, (PixelRect{-8, -8, 24, 20})) << way.front();
        EXPECT_EQ(image.display_window, (PixelRect{0, 0, 16, 12})) << way.front();
        EXPECT_EQ(image.pixels.width, 32) << way.front();
    }
}

// All layers of all kinds, those of half of the samples included.
TEST_F(Layers, OfPartsAreThoseOfTheWhole) {
    for (const char* integrator : {"path", "bdpt"}) {
        const Arguments layers{"--aov", "denoising", "--aov", "passes",  "--aov", "P",  "--aov",        "variance",
                               "--aov", "rays",      "--aov", "samples", "--spp", "32", "--integrator", integrator};
        const auto with = [&](const Arguments& more) {
            Arguments all = layers;
            all.insert(all.end(), more.begin(), more.end());
            return all;
        };
        ASSERT_EQ(render("whole.exr", layers).exit_code, 0);
        ASSERT_EQ(render("a.partial", with({"--samples", "0:16"})).exit_code, 0);
        ASSERT_EQ(render("b.partial", with({"--samples", "16:32"})).exit_code, 0);
        const ProgramResult merged =
            run_etendue({"merge", "a.partial", "b.partial", "-o", "merged.exr", "--float", "--quiet"}, work_);
        ASSERT_EQ(merged.exit_code, 0) << merged.err;
        const ChannelImage whole = read_channels(work_ / "whole.exr");
        const ChannelImage sum = read_channels(work_ / "merged.exr");
        ASSERT_EQ(sum.channel_names, whole.channel_names);
        ASSERT_NE(std::ranges::find(sum.channel_names, "half_albedo.R"), sum.channel_names.end());
        const std::size_t count = sum.channel_names.size();
        for (std::size_t i = 0; i < sum.pixels.pixels.size(); ++i) {
            const float value = whole.pixels.pixels[i];
            // A variance is a small difference of large sums.
            const float tolerance = whole.channel_names[i % count].starts_with("variance") ? 1e-4f : 2e-6f;
            EXPECT_NEAR(sum.pixels.pixels[i], value, tolerance * std::max(1.0f, std::abs(value)))
                << integrator << " " << whole.channel_names[i % count];
        }
    }
}

TEST_F(Layers, OfHalfOfTheSamplesAreThereIfTheyAreAskedFor) {
    const Arguments layers{"--aov", "N", "--aov-layout", "files", "--spp", "64", "--error", "0.5"};
    ASSERT_EQ(render("a.exr", layers).exit_code, 0);
    EXPECT_FALSE(fs::exists(work_ / "a.half.exr")) << "they serve the estimate of the error only";
    Arguments denoising = layers;
    denoising.insert(denoising.end(), {"--aov", "denoising"});
    ASSERT_EQ(render("b.exr", denoising).exit_code, 0);
    EXPECT_TRUE(fs::exists(work_ / "b.half.exr"));
}

TEST_F(Layers, OfAMergeReplaceNoOtherImage) {
    ASSERT_EQ(render("a.N.exr", {}).exit_code, 0);
    const std::string before = read_file(work_ / "a.N.exr");
    ASSERT_EQ(render("a.partial", {"--aov", "N", "--aov-layout", "files"}).exit_code, 0);
    const ProgramResult over_image = run_etendue({"merge", "a.partial", "-o", "a.exr"}, work_);
    EXPECT_EQ(over_image.exit_code, 3) << over_image.err;
    EXPECT_NE(over_image.err.find("a.N.exr, which is an image of its own"), std::string::npos) << over_image.err;
    EXPECT_EQ(read_file(work_ / "a.N.exr"), before);
    ASSERT_EQ(render("b.exr", {"--aov", "N", "--aov-layout", "files"}).exit_code, 0);
    const ProgramResult over_layer = run_etendue({"merge", "a.partial", "-o", "b.N.exr"}, work_);
    EXPECT_EQ(over_layer.exit_code, 3) << over_layer.err;
    EXPECT_NE(over_layer.err.find("b.N.exr is a layer of the image b.exr"), std::string::npos) << over_layer.err;
}

TEST_F(Layers, AreReplacedByNoImageOfStrategies) {
    const ProgramResult result = render(
        "a.exr", {"--integrator", "bdpt", "--aov", "N", "--aov-layout", "files", "--strategies-image", "a.N.exr"});
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_NE(result.err.find("which belongs to the image"), std::string::npos) << result.err;
}

TEST_F(Layers, WhatIsWrongIsSaidWithItsPlace) {
    const auto error = [&](const Arguments& more, int exit_code) {
        const ProgramResult result = render("a.exr", more);
        EXPECT_EQ(result.exit_code, exit_code) << result.err;
        return result.err;
    };
    EXPECT_NE(error({"--aov", "dept"}, 3).find("did you mean 'depth'"), std::string::npos);
    EXPECT_NE(error({"--aov", "a.b=depth"}, 2).find("--aov"), std::string::npos);
    const std::string expression = error({"--aov", "c=lpe:C D X L"}, 3);
    EXPECT_NE(expression.find("--aov: layer 'c': 'X' is no event"), std::string::npos) << expression;
    EXPECT_NE(expression.find("    C D X L\n        ^"), std::string::npos) << expression;
    EXPECT_NE(error({"--aov", "c=lpe:D L"}, 3).find("begins with the camera"), std::string::npos);
    EXPECT_NE(error({"--aov", "a=depth", "--aov", "a=N"}, 3).find("two of this name"), std::string::npos);
    const std::string blind = error({"--aov", "direct", "--integrator", "whitted"}, 3);
    EXPECT_NE(blind.find("'whitted' does not tell paths apart; these do: 'path', "), std::string::npos) << blind;
    EXPECT_NE(blind.find("'vcm'"), std::string::npos) << blind;
    EXPECT_FALSE(fs::exists(work_ / "a.exr"));
}

}  // namespace

}  // namespace etendue::test
