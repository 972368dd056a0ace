#include "cli/settings_options.h"

#include "program/small_files.h"
#include "scene/canonical_settings.h"

#include <array>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>

namespace etendue::test {

namespace {

SettingsOverrides parse(std::vector<std::string> arguments) {
    CLI::App app;
    SettingsOverrides overrides;
    add_settings_options(app, overrides);
    // CLI11 takes them in reverse.
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
    return overrides;
}

RenderSettings settings_of(int width, int height, int spp) {
    RenderSettings settings;
    settings.film.width = width;
    settings.film.height = height;
    settings.spp = spp;
    return settings;
}

TEST(SettingsOverrides, WithoutOptionsNothingChanges) {
    RenderSettings settings = settings_of(640, 360, 100);
    const SettingTexts before = setting_texts(settings);
    parse({}).apply(settings);
    EXPECT_EQ(setting_texts(settings), before);
}

TEST(SettingsOverrides, QualityScalesSizeAndSamples) {
    RenderSettings draft = settings_of(641, 360, 100);
    parse({"--quality", "draft"}).apply(draft);
    EXPECT_EQ(draft.film.width, 320);
    EXPECT_EQ(draft.film.height, 180);
    EXPECT_EQ(draft.spp, 6);
    RenderSettings preview = settings_of(641, 360, 100);
    parse({"--quality", "preview"}).apply(preview);
    EXPECT_EQ(preview.film.width, 641);
    EXPECT_EQ(preview.spp, 25);
    RenderSettings final_quality = settings_of(641, 360, 100);
    parse({"--quality", "final"}).apply(final_quality);
    EXPECT_EQ(final_quality.spp, 100);
    RenderSettings least = settings_of(1, 1, 1);
    parse({"--quality", "draft"}).apply(least);
    EXPECT_EQ(least.film.width, 1);
    EXPECT_EQ(least.spp, 1);
    for (const auto& [spp, buckets] : {std::pair{32, 0}, {48, 3}, {64, 3}, {100, 5}, {112, 7}, {640, 7}}) {
        RenderSettings robust = settings_of(641, 360, spp);
        robust.robust_buckets = 7;
        parse({"--quality", "draft"}).apply(robust);
        EXPECT_EQ(robust.robust_buckets, buckets) << "no bucket may stay empty";
    }
}

TEST(SettingsOverrides, DraftKeepsTheCropInsideTheHalvedImage) {
    for (const std::array<int, 4>& crop :
         {std::array{0, 0, 101, 51}, std::array{100, 50, 101, 51}, std::array{3, 5, 7, 9}, std::array{99, 0, 100, 1}}) {
        RenderSettings settings = settings_of(101, 51, 16);
        settings.film.crop = crop;
        parse({"--quality", "draft"}).apply(settings);
        const FilmSettings& film = settings.film;
        const auto [x0, y0, x1, y1] = *film.crop;
        EXPECT_TRUE(0 <= x0 && x0 < x1 && x1 <= film.width) << x0 << " " << x1 << " of " << film.width;
        EXPECT_TRUE(0 <= y0 && y0 < y1 && y1 <= film.height) << y0 << " " << y1 << " of " << film.height;
    }
}

TEST(SettingsOverrides, TextureMemoryHasAUnit) {
    RenderSettings settings = settings_of(64, 64, 1);
    parse({"--texture-memory", "512M"}).apply(settings);
    EXPECT_EQ(settings.texture_memory, std::uint64_t{512} << 20);
    for (const char* bad : {"512", "M", "-1G", "1.5G", "1 G", "99999999G"})
        EXPECT_THROW(parse({"--texture-memory", bad}), CLI::ValidationError) << bad;
}

TEST(SettingsOverrides, WhatIsStatedWinsOverQuality) {
    RenderSettings settings = settings_of(640, 360, 100);
    parse({"--size", "100x50", "--quality", "draft", "--spp", "7", "--crop", "1,2,30,40"}).apply(settings);
    EXPECT_EQ(settings.film.width, 100);
    EXPECT_EQ(settings.film.height, 50);
    EXPECT_EQ(settings.spp, 7);
    EXPECT_EQ(settings.film.crop, (std::array{1, 2, 30, 40}));
}

TEST(SettingsOverrides, TheEnvironmentIsAnInputOfTheScene) {
    const TestFolder folder;
    write_file(folder / "sky.exr", "");
    SceneDesc scene;
    parse({"--environment", (folder / "sky.exr").string()}).apply_environment(scene);
    EXPECT_TRUE(scene.environment.enabled);
    EXPECT_EQ(scene.environment.image, folder / "sky.exr");
    EXPECT_EQ(scene.inputs.back(), folder / "sky.exr");
    EXPECT_EQ(parse({"--float"}).depth, PixelDepth::Float);
    EXPECT_EQ(parse({"--half"}).depth, PixelDepth::Half);
}

TEST(SettingsOverrides, StrategiesOfBidirectionalPathTracing) {
    RenderSettings settings = settings_of(640, 360, 100);
    parse({"--strategy", "2,3", "--unweighted", "--heuristic", "power"}).apply(settings);
    const IntegratorSettings& integrator = settings.integrator;
    EXPECT_EQ(integrator.strategy, (Strategy{2, 3}));
    EXPECT_FALSE(integrator.weighted);
    EXPECT_EQ(integrator.heuristic, Heuristic::Power);
    for (const char* text : {"2", "2,", "2,3,4", "-1,3", "a,b", "2x3"})
        EXPECT_THROW((void)parse({"--strategy", text}), CLI::ValidationError) << text;
    EXPECT_THROW((void)parse({"--heuristic", "cutoff"}), CLI::ValidationError);
}

TEST(SettingsOverrides, FramesAreOneARangeOrEveryNth) {
    const auto frames = [](const std::string& text) {
        const FrameRange range = parse({"--frames", text}).frames().value();
        std::vector<int> numbers;
        for (std::size_t i = 0; i < range.count(); ++i) numbers.push_back(range.frame(i));
        return numbers;
    };
    EXPECT_EQ(frames("7"), (std::vector{7}));
    EXPECT_EQ(frames("-1:2"), (std::vector{-1, 0, 1, 2}));
    EXPECT_EQ(frames("1:8:3"), (std::vector{1, 4, 7}));
    EXPECT_FALSE(parse({}).frames());
}

TEST(SettingsOverrides, NonsenseIsAUsageError) {
    const std::vector<std::vector<std::string>> bad = {{"--size", "100"},
                                                       {"--size", "100x"},
                                                       {"--size", "0x10"},
                                                       {"--size", "10x99999"},
                                                       {"--size", "10x10x"},
                                                       {"--crop", "1,2,3"},
                                                       {"--crop", "5,0,5,9"},
                                                       {"--crop", "-65537,0,5,9"},
                                                       {"--crop", "0,9,5,0"},
                                                       {"--frames", "3:1"},
                                                       {"--frames", "1:3:0"},
                                                       {"--frames", "1:2:3:4"},
                                                       {"--frames", "1:"},
                                                       {"--frames", "0:1000000"},
                                                       {"--frames", "a"},
                                                       {"--shutter", "0.1"},
                                                       {"--shutter", "0.1:0"},
                                                       {"--shutter", "0:inf"},
                                                       {"--spp", "many"},
                                                       {"--time", "nan"},
                                                       {"--fps", "nan"},
                                                       {"--exposure", "nan"},
                                                       {"--exposure", "inf"},
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
