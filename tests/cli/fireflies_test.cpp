// Firefly control from the command line to the files, and past parts.
#include "image/read_channels.h"
#include "program/run_program.h"
#include "program/small_files.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace etendue::test {

namespace {

namespace fs = std::filesystem;
using Arguments = std::vector<std::string>;
using Json = nlohmann::json;

class Fireflies : public testing::Test {
  protected:
    void SetUp() override {
        fs::create_directories(work_);
        write_scene(folder_ / "box");
    }
    [[nodiscard]] ProgramResult render(const std::string& output, const Arguments& more) const {
        Arguments arguments{"render", (folder_ / "box").string(), "--size", "16x12", "--float", "-o", output};
        arguments.insert(arguments.end(), more.begin(), more.end());
        if (std::ranges::find(more, "--spp") == more.end()) arguments.insert(arguments.end(), {"--spp", "10"});
        return run_etendue(arguments, work_);
    }
    void render_well(const std::string& output, const Arguments& more) const {
        const ProgramResult result = render(output, more);
        ASSERT_EQ(result.exit_code, 0) << result.err;
    }
    void expect_refused(const Arguments& more, const std::string& why) const {
        const ProgramResult result = render("refused.exr", more);
        EXPECT_NE(result.exit_code, 0);
        EXPECT_NE(result.err.find(why), std::string::npos) << result.err;
    }
    [[nodiscard]] Json statistics(const std::string& file) const { return Json::parse(read_file(work_ / file)); }
    [[nodiscard]] std::vector<float> pixels(const std::string& file) const {
        return read_channels(work_ / file).pixels.pixels;
    }

    TestFolder folder_;
    fs::path work_ = folder_ / "work";
};

TEST_F(Fireflies, AreLeftAloneUnlessAskedFor) {
    render_well("a.exr", {});
    render_well("b.exr", {"--clamp-indirect", "1e20"});
    EXPECT_EQ(pixels("a.exr"), pixels("b.exr"));
    EXPECT_TRUE(statistics("a.json")["clamp_indirect"].is_null());
    EXPECT_TRUE(statistics("a.json")["robust"].is_null());
    EXPECT_EQ(statistics("b.json")["clamp_indirect"]["removed_share"], 0.0);
}

TEST_F(Fireflies, AreRecorded) {
    render_well("a.exr", {"--clamp-indirect", "0.01", "--robust", "mon:3", "--aov", "mean", "--aov", "clamped"});
    const Json json = statistics("a.json");
    EXPECT_FLOAT_EQ(json["clamp_indirect"]["limit"].get<float>(), 0.01f);
    EXPECT_EQ(json["robust"]["estimate"], "mon:3");
    EXPECT_EQ(json["brightest"].size(), 8u);
    for (const char* key : {"pixel", "sample", "value", "strategy", "edges", "path"})
        EXPECT_FALSE(json["brightest"][0][key].is_null()) << key;
    std::vector<std::string> names = read_channels(work_ / "a.exr").channel_names;
    for (const char* name : {"mean.R", "clamped.G"}) EXPECT_NE(std::ranges::find(names, name), names.end()) << name;
}

TEST_F(Fireflies, AreListedWhenAskedFor) {
    const ProgramResult result = render("a.exr", {"--brightest", "3"});
    EXPECT_NE(result.err.find("brightest contributions"), std::string::npos) << result.err;
    EXPECT_EQ(statistics("a.json")["brightest"].size(), 3u);
    render_well("b.exr", {"--brightest", "0"});
    EXPECT_EQ(statistics("b.json")["brightest"].size(), 0u);
}

TEST_F(Fireflies, GoThroughPartsAsThroughOneRender) {
    const Arguments options{"--robust", "mon:5", "--clamp-indirect", "0.05", "--integrator", "bdpt"};
    const auto with = [&](Arguments more) {
        more.insert(more.end(), options.begin(), options.end());
        return more;
    };
    render_well("whole.exr", with({"--spp", "48"}));
    render_well("a.partial", with({"--spp", "48", "--samples", "0:16"}));
    render_well("b.partial", with({"--spp", "48", "--samples", "16:48"}));
    const ProgramResult merged = run_etendue({"merge", "a.partial", "b.partial", "-o", "merged.exr", "--float"}, work_);
    ASSERT_EQ(merged.exit_code, 0) << merged.err;
    const std::vector<float> one = pixels("whole.exr");
    const std::vector<float> two = pixels("merged.exr");
    ASSERT_EQ(one.size(), two.size());
    for (std::size_t i = 0; i < one.size(); ++i) EXPECT_NEAR(one[i], two[i], 1e-5f * (1.0f + one[i]));
    EXPECT_EQ(statistics("whole.json")["brightest"], statistics("merged.json")["brightest"]);
    EXPECT_EQ(statistics("merged.json")["robust"]["estimate"], "mon:5");
    EXPECT_NEAR(statistics("merged.json")["clamp_indirect"]["removed_share"].get<double>(),
                statistics("whole.json")["clamp_indirect"]["removed_share"].get<double>(), 1e-6);
}

TEST_F(Fireflies, AMedianHasNoHalves) {
    render_well("a.exr", {"--robust", "mon:5", "--error", "0.01", "--spp", "64", "--aov", "mean"});
    for (const std::string& name : read_channels(work_ / "a.exr").channel_names)
        EXPECT_FALSE(name.starts_with("half")) << name;
    render_well("b.exr", {"--error", "0.01", "--spp", "64", "--aov", "mean", "--aov", "denoising"});
    const auto names = read_channels(work_ / "b.exr").channel_names;
    EXPECT_NE(std::ranges::find(names, "half.R"), names.end()) << "a mean has";
}

TEST_F(Fireflies, AMedianOfFewMeansSaysSo) {
    render_well("a.exr", {"--robust", "mon:7"});
    EXPECT_EQ(statistics("a.json")["robust"]["least_buckets"], 7);
    render_well("a.partial", {"--robust", "mon:7", "--samples", "0:2"});
    const ProgramResult merged = run_etendue({"merge", "a.partial", "-o", "b.exr"}, work_);
    EXPECT_EQ(merged.exit_code, 0) << merged.err;
    EXPECT_NE(merged.err.find("only 2 means"), std::string::npos) << merged.err;
    EXPECT_EQ(statistics("b.json")["robust"]["least_buckets"], 2);
}

TEST_F(Fireflies, AreNotToBeControlledByWhatMakesNoSense) {
    expect_refused({"--robust", "mon:4"}, "N odd");
    expect_refused({"--robust", "median"}, "N odd");
    expect_refused({"--robust", "mon:33"}, "N odd");
    expect_refused({"--robust", "mon:11"}, "buckets would stay empty");
    expect_refused({"--robust", "mon:3", "--aov", "denoising"}, "--robust");
    expect_refused({"--robust", "mon:3", "--integrator", "normals"}, "shows no light");
    expect_refused({"--clamp-indirect", "1", "--integrator", "whitted"}, "no indirect light");
    expect_refused({"--clamp-indirect", "1", "--integrator", "direct"}, "no indirect light");
    expect_refused({"--clamp-indirect", "-1"}, "--clamp-indirect");
    expect_refused({"--aov", "clamped"}, "--clamp-indirect");
    expect_refused({"--brightest", "2000"}, "--brightest");
}

TEST_F(Fireflies, WhatHasNoEffectIsNoted) {
    const std::string without = "note: --min-spp has no effect";
    EXPECT_NE(render("a.exr", {"--min-spp", "64"}).err.find(without), std::string::npos);
    EXPECT_EQ(render("a.exr", {"--min-spp", "64", "--error", "0.5"}).err.find(without), std::string::npos);
    const std::string direct_only = "note: --clamp-indirect has no effect";
    EXPECT_NE(render("a.exr", {"--clamp-indirect", "1", "--max-depth", "2"}).err.find(direct_only), std::string::npos);
    EXPECT_EQ(render("a.exr", {"--clamp-indirect", "1", "--max-depth", "3"}).err.find(direct_only), std::string::npos);
}

TEST_F(Fireflies, CanBeControlledByRenderJson) {
    write_scene(folder_ / "box", R"("clamp_indirect": 0.02, "robust": "mon:3", "brightest": 2,)");
    render_well("a.exr", {});
    EXPECT_FLOAT_EQ(statistics("a.json")["clamp_indirect"]["limit"].get<float>(), 0.02f);
    EXPECT_EQ(statistics("a.json")["robust"]["estimate"], "mon:3");
    EXPECT_EQ(statistics("a.json")["brightest"].size(), 2u);
    render_well("b.exr", {"--clamp-indirect", "0", "--robust", "mean"});
    EXPECT_TRUE(statistics("b.json")["clamp_indirect"].is_null());
    EXPECT_TRUE(statistics("b.json")["robust"].is_null());
    write_scene(folder_ / "box", R"("robust": "mon:6",)");
    expect_refused({}, "/robust");
}

}  // namespace

}  // namespace etendue::test
