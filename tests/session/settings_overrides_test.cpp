#include "session/settings_overrides.h"

#include "program/small_files.h"

#include <array>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>

namespace etendue::test {

namespace {

SettingsOverrides parse(std::vector<std::string> arguments) {
    CLI::App app;
    SettingsOverrides overrides;
    overrides.add_options(app);
    // CLI11 takes them in reverse.
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
    return overrides;
}

SceneDesc scene_of(int width, int height, int spp) {
    SceneDesc scene;
    scene.settings.film.width = width;
    scene.settings.film.height = height;
    scene.settings.spp = spp;
    return scene;
}

TEST(SettingsOverrides, WithoutOptionsNothingChanges) {
    SceneDesc scene = scene_of(640, 360, 100);
    const std::string before = dump(scene);
    parse({}).apply(scene);
    EXPECT_EQ(dump(scene), before);
}

TEST(SettingsOverrides, QualityScalesSizeAndSamples) {
    SceneDesc draft = scene_of(641, 360, 100);
    parse({"--quality", "draft"}).apply(draft);
    EXPECT_EQ(draft.settings.film.width, 320);
    EXPECT_EQ(draft.settings.film.height, 180);
    EXPECT_EQ(draft.settings.spp, 6);
    SceneDesc preview = scene_of(641, 360, 100);
    parse({"--quality", "preview"}).apply(preview);
    EXPECT_EQ(preview.settings.film.width, 641);
    EXPECT_EQ(preview.settings.spp, 25);
    SceneDesc final_quality = scene_of(641, 360, 100);
    parse({"--quality", "final"}).apply(final_quality);
    EXPECT_EQ(final_quality.settings.spp, 100);
    SceneDesc least = scene_of(1, 1, 1);
    parse({"--quality", "draft"}).apply(least);
    EXPECT_EQ(least.settings.film.width, 1);
    EXPECT_EQ(least.settings.spp, 1);
}

TEST(SettingsOverrides, DraftKeepsTheCropInsideTheHalvedImage) {
    for (const std::array<int, 4>& crop :
         {std::array{0, 0, 101, 51}, std::array{100, 50, 101, 51}, std::array{3, 5, 7, 9}, std::array{99, 0, 100, 1}}) {
        SceneDesc scene = scene_of(101, 51, 16);
        scene.settings.film.crop = crop;
        parse({"--quality", "draft"}).apply(scene);
        const FilmSettings& film = scene.settings.film;
        const auto [x0, y0, x1, y1] = *film.crop;
        EXPECT_TRUE(0 <= x0 && x0 < x1 && x1 <= film.width) << x0 << " " << x1 << " of " << film.width;
        EXPECT_TRUE(0 <= y0 && y0 < y1 && y1 <= film.height) << y0 << " " << y1 << " of " << film.height;
    }
}

TEST(SettingsOverrides, TextureMemoryHasAUnit) {
    SceneDesc scene = scene_of(64, 64, 1);
    parse({"--texture-memory", "512M"}).apply(scene);
    EXPECT_EQ(scene.settings.texture_memory, std::uint64_t{512} << 20);
    for (const char* bad : {"512", "M", "-1G", "1.5G", "1 G", "99999999G"})
        EXPECT_THROW(parse({"--texture-memory", bad}), CLI::ValidationError) << bad;
}

TEST(SettingsOverrides, MissingTexturesMatterWhenTheSceneIsLoaded) {
    EXPECT_EQ(parse({}).moment.missing_textures, std::nullopt);
    EXPECT_EQ(parse({"--missing-textures", "warn"}).moment.missing_textures, MissingTextures::Warn);
    EXPECT_EQ(parse({"--missing-textures", "error"}).moment.missing_textures, MissingTextures::Error);
}

TEST(SettingsOverrides, WhatIsStatedWinsOverQuality) {
    SceneDesc scene = scene_of(640, 360, 100);
    parse({"--size", "100x50", "--quality", "draft", "--spp", "7", "--crop", "1,2,30,40"}).apply(scene);
    EXPECT_EQ(scene.settings.film.width, 100);
    EXPECT_EQ(scene.settings.film.height, 50);
    EXPECT_EQ(scene.settings.spp, 7);
    EXPECT_EQ(scene.settings.film.crop, (std::array{1, 2, 30, 40}));
}

TEST(SettingsOverrides, EachOptionReachesItsSetting) {
    const TestFolder folder;
    write_file(folder / "sky.exr", "");
    SceneDesc scene = scene_of(640, 360, 100);
    const SettingsOverrides overrides = parse({"--integrator",
                                               "naive",
                                               "--camera",
                                               "side",
                                               "--seed",
                                               "4294967295",
                                               "--time",
                                               "2.5",
                                               "--max-depth",
                                               "3",
                                               "--environment",
                                               (folder / "sky.exr").string(),
                                               "--exposure",
                                               "-1.5",
                                               "--view",
                                               "Raw",
                                               "--working-space",
                                               "ACEScg",
                                               "--float",
                                               "--light-units",
                                               "radiometric",
                                               "--min-depth",
                                               "2",
                                               "--light-samples",
                                               "4"});
    overrides.apply(scene);
    EXPECT_EQ(scene.settings.integrator.type, "naive");
    EXPECT_EQ(scene.settings.camera, "side");
    EXPECT_EQ(scene.settings.seed, 4294967295u);
    EXPECT_EQ(scene.settings.time_limit, 2.5);
    EXPECT_EQ(scene.settings.light_units, LightUnits::Radiometric);
    EXPECT_EQ(scene.settings.integrator.max_depth, 3);
    EXPECT_EQ(scene.settings.integrator.min_depth, 2);
    EXPECT_EQ(scene.settings.integrator.light_samples, 4);
    EXPECT_TRUE(scene.environment.enabled);
    EXPECT_EQ(scene.environment.image, folder / "sky.exr");
    EXPECT_EQ(scene.settings.color.exposure, -1.5f);
    EXPECT_EQ(scene.settings.color.view, "Raw");
    EXPECT_EQ(scene.settings.color.working_space, "ACEScg");
    EXPECT_EQ(overrides.depth, PixelDepth::Float);
    EXPECT_EQ(parse({"--half"}).depth, PixelDepth::Half);
    // A scene rendered with another image depends on that image.
    EXPECT_EQ(scene.inputs.back(), folder / "sky.exr");
}

TEST(SettingsOverrides, StrategiesOfBidirectionalPathTracing) {
    SceneDesc scene = scene_of(640, 360, 100);
    parse({"--strategy", "2,3", "--unweighted", "--heuristic", "power"}).apply(scene);
    const IntegratorSettings& integrator = scene.settings.integrator;
    EXPECT_EQ(integrator.strategy, (std::array<int, 2>{2, 3}));
    EXPECT_FALSE(integrator.weighted);
    EXPECT_EQ(integrator.heuristic, HeuristicType::Power);
    for (const char* text : {"2", "2,", "2,3,4", "-1,3", "a,b", "2x3"})
        EXPECT_THROW((void)parse({"--strategy", text}), CLI::ValidationError) << text;
    EXPECT_THROW((void)parse({"--heuristic", "cutoff"}), CLI::ValidationError);
}

TEST(SettingsOverrides, ConnectionsArePairwiseOrToACache) {
    EXPECT_EQ(parse({"--bdpt-connections", "pairwise"}).cached_connections, 0);
    EXPECT_EQ(parse({"--bdpt-connections", "cache:1"}).cached_connections, 1);
    EXPECT_EQ(parse({"--bdpt-connections", "cache:999"}).cached_connections, 999);
    for (const char* text : {"", "cache", "cache:", "cache:0", "cache:-1", "cache:1000", "cache:2x", "cache: 2", "all"})
        EXPECT_THROW((void)parse({"--bdpt-connections", text}), CLI::ValidationError) << text;
}

TEST(SettingsOverrides, FramesAreOneARangeOrEveryNth) {
    const auto frames = [](const std::string& text) {
        const FrameRange range = parse({"--frames", text}).frames.value();
        std::vector<int> numbers;
        for (std::size_t i = 0; i < range.count(); ++i) numbers.push_back(range.frame(i));
        return numbers;
    };
    EXPECT_EQ(frames("7"), (std::vector{7}));
    EXPECT_EQ(frames("-1:2"), (std::vector{-1, 0, 1, 2}));
    EXPECT_EQ(frames("1:8:3"), (std::vector{1, 4, 7}));
    EXPECT_FALSE(parse({}).frames);
}

TEST(SettingsOverrides, NonsenseIsAUsageError) {
    const std::vector<std::vector<std::string>> bad = {{"--size", "100"},
                                                       {"--size", "100x"},
                                                       {"--size", "0x10"},
                                                       {"--size", "10x99999"},
                                                       {"--size", "10x10x"},
                                                       {"--crop", "1,2,3"},
                                                       {"--crop", "5,0,5,9"},
                                                       {"--crop", "-1,0,5,9"},
                                                       {"--crop", "0,9,5,0"},
                                                       {"--frames", "3:1"},
                                                       {"--frames", "1:3:0"},
                                                       {"--frames", "1:2:3:4"},
                                                       {"--frames", "1:"},
                                                       {"--frames", "0:1000000"},
                                                       {"--frames", "a"},
                                                       {"--fps", "0"},
                                                       {"--shutter", "0.1"},
                                                       {"--shutter", "0.1:0"},
                                                       {"--shutter", "0:inf"},
                                                       {"--spp", "0"},
                                                       {"--spp", "16777217"},
                                                       {"--spp", "many"},
                                                       {"--seed", "-1"},
                                                       {"--time", "0"},
                                                       {"--time", "-3"},
                                                       {"--time", "nan"},
                                                       {"--fps", "nan"},
                                                       {"--exposure", "nan"},
                                                       {"--exposure", "inf"},
                                                       {"--max-depth", "0"},
                                                       {"--min-depth", "0"},
                                                       {"--light-samples", "0"},
                                                       {"--light-samples", "65"},
                                                       {"--quality", "best"},
                                                       {"--integrator", "photons"},
                                                       {"--environment", "/no/such/file.exr"},
                                                       {"--light-units", "watts"},
                                                       {"--missing-textures", "pink"},
                                                       {"--half", "--float"},
                                                       {"--colour", "red"}};
    for (const auto& arguments : bad)
        EXPECT_THROW((void)parse(arguments), CLI::ParseError) << arguments[0] << " " << arguments.back();
}

}  // namespace

}  // namespace etendue::test
