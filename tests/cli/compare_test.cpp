// etendue compare from outside: what it measures of small scenes, and how it says what is wrong.
#include "image/read.h"
#include "image/write.h"
#include "program/run_program.h"
#include "program/small_files.h"
#include "report/comparison_report.h"

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace etendue::test {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Names = std::vector<std::string>;

class Compare : public testing::Test {
  protected:
    void SetUp() override {
        fs::create_directories(work_);
        write_scene(folder_ / "box");
    }
    /// With all that it says on stderr.
    [[nodiscard]] ProgramResult compare_aloud(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), {"compare", (folder_ / "box").string(), "-o", "report"});
        return run_etendue(arguments, work_);
    }
    [[nodiscard]] ProgramResult compare(std::vector<std::string> arguments) const {
        arguments.emplace_back("--quiet");
        return compare_aloud(arguments);
    }
    /// An EXR of the scene's size, grey but for its first value.
    void write_grey(const std::string& name, float first = 0.5f) const {
        ImageF image(16, 12, 3);
        image.pixels.assign(image.pixels.size(), 0.5f);
        image.pixels.front() = first;
        write_image(work_ / name, image, {.depth = PixelDepth::Float});
    }
    [[nodiscard]] json report() const { return json::parse(read_file(work_ / "report/report.json")); }
    [[nodiscard]] std::string notes() const { return report()["notes"].dump(); }

    TestFolder folder_;
    fs::path work_ = folder_ / "work";
};

TEST_F(Compare, MeasuresVariantsAgainstEachOther) {
    const ProgramResult result =
        compare({"--spp", "8", "--seeds", "3", "--strategies-depth", "2", "--region", "corner: a:0,0,4,3"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(result.out.empty()) << result.out;
    Names files = list(work_ / "report");
    std::erase_if(files, [](const std::string& name) { return name.starts_with("plots/"); });
    EXPECT_EQ(files, (Names{"data.csv", "index.html", "plots", "reference.exr", "report.json", "tables.tex"}))
        << "and nothing else";
    EXPECT_EQ(list(work_ / "report/plots").size(), 20u) << "five metrics over time and samples, as SVG and PDF";
    EXPECT_TRUE(read_file(work_ / "report/plots/relmse-time.pdf").starts_with("%PDF"));
    // A line of names; of two variants and three seeds, six images each on the way and the last one's region.
    EXPECT_EQ(std::ranges::count(read_file(work_ / "report/data.csv"), '\n'), 1 + 2 * 3 * (6 + 1));
    const json report = this->report();
    EXPECT_EQ(report["settings"]["spp"], 8);
    EXPECT_TRUE(report["settings"]["seconds"].is_null());
    EXPECT_EQ(report["reference"]["kind"], "pooled");
    EXPECT_NEAR(
        report["reference"]["weights"]["path"].get<double>() + report["reference"]["weights"]["bdpt"].get<double>(),
        1.0, 1e-9);
    ASSERT_EQ(report["variants"].size(), 2u);
    for (const json& variant : report["variants"]) {
        EXPECT_EQ(variant["spp"], 8);
        EXPECT_EQ(variant["errors"]["relmse"]["values"].size(), 3u);
        EXPECT_GT(variant["errors"]["relmse"]["mean"], 0.0);
        EXPECT_GT(variant["errors"]["flip"]["mean"], 0.0);
        std::vector<int> kept;
        for (const json& step : variant["convergence"]) kept.push_back(step["spp"]);
        EXPECT_EQ(kept, (std::vector<int>{1, 2, 3, 4, 6, 8}));
        EXPECT_LT(variant["slopes"]["relmse"]["spp"], -0.5);
    }
    ASSERT_EQ(report["pairs"].size(), 1u);
    EXPECT_EQ(report["pairs"][0]["agreement"]["agree"], true);
    EXPECT_TRUE(report["pairs"][0]["ratios"].contains("relmse_time"));
    EXPECT_GT(report["pairs"][0]["agreement"]["smallest_seen"]["image"], 0.0);
    EXPECT_TRUE(report["not_tested"].empty());
    EXPECT_EQ(report["regions"][0]["name"], "corner: a");
    EXPECT_EQ(report["strategies"]["rows"].size(), 2u);
    const std::string page = read_file(work_ / "report/index.html");
    for (const char* image :
         {"image/path", "image/bdpt", "reference", "error/relmse/bdpt", "error/flip/path", "z/path/bdpt",
          "strategy/weighted/1,2", "strategy/unweighted/2,1", "strategy/weights/0,2"})
        EXPECT_NE(page.find(std::string("\"") + image + "\":"), std::string::npos) << image;
}

TEST_F(Compare, TheNextComparisonTakesAPooledReference) {
    const std::vector<std::string> arguments{"--spp", "4", "--seeds", "3", "--strategies-depth", "0"};
    ASSERT_EQ(compare(arguments).exit_code, 0);
    const double noise = report()["reference"]["noise_relmse"];
    fs::rename(work_ / "report/reference.exr", work_ / "pooled.exr");
    std::vector<std::string> next = arguments;
    next.insert(next.end(), {"--reference", "pooled.exr", "--keep-images"});
    ASSERT_EQ(compare(next).exit_code, 0);
    json report = this->report();
    // That of each image's own reference, which has no part of its round, against that of all three rounds.
    EXPECT_NEAR(report["reference"]["noise_relmse"], noise * 2.0 / 3.0, 0.1 * noise);
    EXPECT_EQ(report["variants"][0]["seeds"], (json{6, 8, 10})) << "after those of the reference";
    EXPECT_NE(notes().find("seeds begin with 6"), std::string::npos) << notes();
    EXPECT_FALSE(fs::exists(work_ / "report/reference.exr"));
    EXPECT_EQ(list(work_ / "report/images").size(), 6u);
    EXPECT_TRUE(fs::exists(work_ / "report/images/bdpt-seed7.exr"));
    write_grey("report/images/path-seed99.exr");
    next.insert(next.end(), {"--seed", "5"});
    ASSERT_EQ(compare(next).exit_code, 0);
    EXPECT_FALSE(fs::exists(work_ / "report/images/bdpt-seed7.exr")) << "another comparison's";
    EXPECT_TRUE(fs::exists(work_ / "report/images/path-seed99.exr")) << "none of Etendue's";
    EXPECT_EQ(list(work_ / "report/images").size(), 7u);
    EXPECT_NE(notes().find("some of the same seeds"), std::string::npos) << notes();
}

TEST_F(Compare, KeepsImagesThatItHasNotMade) {
    fs::create_directories(work_ / "report");
    write_grey("report/reference.exr");
    const Names one{"--spp", "1", "--seeds", "1", "--integrators", "path", "--strategies-depth", "0"};
    ASSERT_EQ(compare(one).exit_code, 0);
    EXPECT_TRUE(fs::exists(work_ / "report/reference.exr"));
    Names kept = one;
    kept.emplace_back("--keep-images");
    ASSERT_EQ(compare(kept).exit_code, 0);
    kept.insert(kept.end(), {"--reference", "report/images/path-seed0.exr"});
    EXPECT_EQ(compare(kept).exit_code, 2);
    EXPECT_TRUE(fs::exists(work_ / "report/images/path-seed0.exr"));
}

TEST_F(Compare, OverscanIsPartOfTheWindow) {
    const Names wide{"--size", "24x24", "--overscan", "4", "--spp", "2", "--seeds", "3", "--strategies-depth", "0"};
    ASSERT_EQ(compare(wide).exit_code, 0);
    EXPECT_EQ(report()["scene"]["crop"], (json{-4, -4, 28, 28}));
    ASSERT_TRUE(fs::exists(work_ / "report/reference.exr")) << notes();
    fs::rename(work_ / "report/reference.exr", work_ / "wide.exr");
    EXPECT_EQ(compare({"--size", "24x24", "--spp", "2", "--seeds", "1", "--integrators", "path", "--reference",
                       "wide.exr", "--strategies-depth", "0"})
                  .exit_code,
              0);
}

TEST_F(Compare, AcceleratorsShowTheSameLight) {
    const ProgramResult result = compare({"--spp", "2", "--seeds", "3", "--variant", "embree: ", "--variant",
                                          "bvh: --accelerator bvh", "--strategies-depth", "0"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(report()["pairs"][0]["agreement"].is_object()) << report()["pairs"][0].dump();
}

TEST_F(Compare, RefusesWhatWouldChangeNothing) {
    for (const Names& options :
         {Names{"--aov", "depth"}, Names{"--deep"}, Names{"--owner", "x"}, Names{"--exr-space", "ACEScg"},
          Names{"--integrator", "path"}, Names{"--seeds", "2"}, Names{"--variant", "red"}, Names{"--variant", ": "},
          Names{"--variant", "a: ", "--variant", "a: "}, Names{"--seeds", "1", "--variant", "a: --deep"},
          Names{"--integrators", "path"}, Names{"--variant", "a: ", "--seeds", "3"}}) {
        const ProgramResult result = compare_aloud(options);
        EXPECT_EQ(result.exit_code, 2) << options.front() << " " << options.back() << result.err;
        EXPECT_EQ(result.err.find("1/"), std::string::npos) << "rendered before: " << result.err;
    }
    const ProgramResult strategies =
        compare({"--integrators", "path", "--spp", "1", "--seeds", "1", "--strategies-depth", "2"});
    EXPECT_EQ(strategies.exit_code, 3) << strategies.err;
    write_grey("grey.exr");
    EXPECT_EQ(compare({"--seeds", "2", "--spp", "1", "--integrators", "path", "--reference", "grey.exr"}).exit_code, 0);
}

TEST_F(Compare, LooksAtClassesOfLight) {
    const ProgramResult result =
        compare_aloud({"--spp", "1", "--seeds", "1", "--insets", "specular_direct,volume_direct", "--region",
                       "a:0,0,2,2", "--strategies-depth", "0"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("note: the image has no light of the class 'volume_direct'"), std::string::npos)
        << result.err;
    const json report = this->report();
    ASSERT_EQ(report["regions"].size(), 2u);
    EXPECT_EQ(report["regions"][1]["name"], "specular_direct");
    EXPECT_NE(notes().find("no light of the class 'volume_direct'"), std::string::npos) << notes();
    fs::remove_all(work_ / "report");
    for (const char* mistake : {"depth", "caustic"}) EXPECT_EQ(compare({"--insets", mistake}).exit_code, 3) << mistake;
    EXPECT_FALSE(fs::exists(work_ / "report")) << "it is made after all was looked at";
}

TEST_F(Compare, NamedVariantsStandBesideIntegrators) {
    ASSERT_EQ(compare({"--spp", "1", "--seeds", "1", "--integrators", "path", "--variant",
                       "power law: --integrator bdpt --heuristic power", "--strategies-depth", "0", "--wall"})
                  .exit_code,
              0);
    const json report = this->report();
    ASSERT_EQ(report["variants"].size(), 2u);
    EXPECT_EQ(report["variants"][1]["name"], "power law");
    EXPECT_EQ(report["settings"]["time"], "wall");
    EXPECT_EQ(report["not_tested"].size(), 2u);
    EXPECT_FALSE(fs::exists(work_ / "report/plots")) << "without a reference";
}

TEST_F(Compare, StrategiesThatAreLeftOutAreANote) {
    const ProgramResult result = compare({"--spp", "2", "--seeds", "1", "--min-depth", "3", "--strategies-depth", "2"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const json report = this->report();
    EXPECT_FALSE(report.contains("strategies"));
    EXPECT_NE(report["notes"].dump().find("--min-depth"), std::string::npos) << report["notes"];
}

TEST_F(Compare, TheCommandsOfTheReportRenderItsImages) {
    ASSERT_EQ(
        compare({"--spp", "4", "--seeds", "3", "--seed", "5", "--size", "12x8", "--strategies-depth", "0"}).exit_code,
        0);
    const json report = this->report();
    const std::string command = report["variants"][1]["command"];
    for (const char* part : {"etendue render", "--integrator 'bdpt'", "--spp 4 --seed 6", "--size '12x8'"})
        EXPECT_NE(command.find(part), std::string::npos) << part << " in " << command;
    EXPECT_EQ(command.find("--seeds"), std::string::npos) << command;
    EXPECT_NE(report["command"].get<std::string>().find("--seeds '3'"), std::string::npos) << report["command"];
    EXPECT_FALSE(report.contains("strategies"));
}

std::array<double, 3> mean_of_file(const fs::path& file) {
    const ImageF image = read_image_float(file);
    std::array<double, 3> mean{};
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (std::size_t c = 0; c < 3; ++c)
                mean[c] += static_cast<double>(image.pixel(x, y)[c]) / (image.width * image.height);
    return mean;
}

TEST_F(Compare, EveryPrintedCommandRemakesItsImage) {
    write_scene(folder_ / "box", R"("time": 1e-9, )");
    // What one of them says and all say, scenes with a limit of time, and words that a shell would take apart.
    ASSERT_EQ(compare({"--spp",
                       "6",
                       "--seeds",
                       "1",
                       "--seed",
                       "7",
                       "--integrator",
                       "path",
                       "--max-depth",
                       "3",
                       "--camera",
                       "main",
                       "--strategies-depth",
                       "0",
                       "--variant",
                       "a: --max-depth 2 --integrator bdpt",
                       "--variant",
                       "b: --integrator light --camera main",
                       "--variant",
                       "c: --quality preview",
                       "--variant",
                       "d: --integrator bdpt --strategy 1,2 --unweighted"})
                  .exit_code,
              0);
    const json report = this->report();
    for (const json& variant : report["variants"]) {
        std::string command = variant["command"];
        ASSERT_TRUE(command.starts_with("etendue render ")) << command;
        EXPECT_TRUE(variant["command_note"].is_null()) << variant["command_note"];
        command.replace(0, std::string("etendue").size(), ETENDUE_PROGRAM);
        ASSERT_EQ(std::system(("cd '" + work_.string() + "' && " + command + " --quiet").c_str()), 0) << command;
        const std::array<double, 3> mean = mean_of_file(work_ / "image.exr");
        for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], variant["mean"][c].get<double>(), 1e-6) << command;
    }
    // And the comparison's own.
    std::string command = report["command"];
    command.replace(0, std::string("etendue").size(), ETENDUE_PROGRAM);
    ASSERT_EQ(std::system(("cd '" + work_.string() + "' && " + command).c_str()), 0) << command;
    EXPECT_EQ(this->report()["command"], report["command"]);
}

TEST_F(Compare, HasMergingWhereTheSceneHasMirrors) {
    const auto names = [&] {
        Names found;
        const json written = report();
        for (const json& variant : written["variants"]) found.push_back(variant["name"]);
        return found;
    };
    const std::vector<std::string> arguments{"--spp", "1", "--seeds", "1", "--strategies-depth", "0"};
    ASSERT_EQ(compare(arguments).exit_code, 0);
    EXPECT_EQ(names(), (Names{"path", "bdpt"}));
    const fs::path file = folder_ / "box/scene.gltf";
    std::string text = read_file(file);
    constexpr std::string_view kPrimitive = R"({"attributes": {"POSITION": 0}})";
    text.replace(text.find(kPrimitive), kPrimitive.size(), R"({"material": 0, "attributes": {"POSITION": 0}})");
    text.insert(text.rfind('}'), R"(, "materials": [{"pbrMetallicRoughness": {"roughnessFactor": 0}}])");
    write_file(file, text);
    ASSERT_EQ(compare(arguments).exit_code, 0);
    EXPECT_EQ(names(), (Names{"path", "bdpt", "vcm"}));
}

TEST_F(Compare, TheComparisonsCommandNamesEachOfSeveralValues) {
    const std::vector<std::string> arguments{
        "--spp",    "1",         "--seeds",       "1",         "--region",           "a:0,0,4,4",
        "--region", "b:1,1,5,5", "--integrators", "path,bdpt", "--strategies-depth", "0"};
    ASSERT_EQ(compare(arguments).exit_code, 0);
    std::string command = report()["command"];
    command.replace(0, std::string("etendue").size(), ETENDUE_PROGRAM);
    ASSERT_EQ(std::system(("cd '" + work_.string() + "' && " + command).c_str()), 0) << command;
    EXPECT_EQ(report()["regions"].size(), 2u);
}

TEST_F(Compare, SaysThatCachedConnectionsHaveOtherNoise) {
    ASSERT_EQ(
        compare({"--spp", "1", "--seeds", "1", "--strategies-depth", "0", "--bdpt-connections", "cache:2"}).exit_code,
        0);
    EXPECT_TRUE(report()["variants"][0]["command_note"].is_null()) << "path has none";
    EXPECT_NE(report()["variants"][1]["command_note"].dump().find("other noise"), std::string::npos);
}

TEST_F(Compare, NoTwoRendersHaveTheSameSeed) {
    ASSERT_EQ(compare({"--spp", "1", "--seeds", "3", "--seed", "4294967294", "--integrators", "path,bdpt,naive",
                       "--strategies-depth", "0"})
                  .exit_code,
              0);
    std::set<std::uint32_t> seeds;
    const json report = this->report();
    for (const json& variant : report["variants"]) {
        ASSERT_EQ(variant["seeds"].size(), 3u);
        for (const std::uint32_t seed : variant["seeds"]) EXPECT_TRUE(seeds.insert(seed).second) << seed;
        EXPECT_NE(variant["command"].get<std::string>().find("--seed " + variant["seeds"][0].dump() + " "),
                  std::string::npos)
            << variant["command"];
    }
    EXPECT_TRUE(seeds.contains(4294967294u)) << "the first";
    EXPECT_TRUE(seeds.contains(0u)) << "after the last there is";
}

TEST_F(Compare, TakesAnyTwoSettings) {
    ASSERT_EQ(compare({"--spp", "4", "--seeds", "3", "--integrator", "bdpt", "--variant", "a: --max-depth 2",
                       "--variant", "b: --max-depth 2 --heuristic power", "--strategies-depth", "0"})
                  .exit_code,
              0);
    const json report = this->report();
    EXPECT_EQ(report["variants"][0]["name"], "a");
    EXPECT_EQ(report["variants"][0]["options"], "--max-depth 2");
    EXPECT_EQ(report["variants"][1]["options"], "--max-depth 2 --heuristic power");
    EXPECT_EQ(report["pairs"][0]["comparable"], true);
    EXPECT_EQ(report["reference"]["kind"], "pooled");
    EXPECT_NE(notes().find("would not be seen"), std::string::npos) << "bdpt is measured against itself: " << notes();
}

TEST_F(Compare, SamplersMakeTheSameLight) {
    ASSERT_EQ(compare({"--spp", "1", "--seeds", "1", "--integrator", "path", "--variant", "a: --sampler sobol",
                       "--variant", "b: --sampler random"})
                  .exit_code,
              0);
    const json report = this->report();
    EXPECT_TRUE(report["pairs"][0]["different_light"].is_null()) << report["pairs"][0]["different_light"];
    EXPECT_NE(report["variants"][0]["mean"], report["variants"][1]["mean"]);
}

TEST_F(Compare, DifferentLightIsNotTested) {
    write_grey("grey.exr");
    const std::vector<std::string> depths{"--spp", "64",        "--seeds",          "4",         "--integrator",
                                          "path",  "--variant", "a: --max-depth 1", "--variant", "b: --max-depth 2"};
    EXPECT_EQ(compare(depths).exit_code, 0) << "they differ by design";
    json report = this->report();
    EXPECT_EQ(report["pairs"][0]["comparable"], false);
    EXPECT_NE(report["pairs"][0]["different_light"].dump().find("1 to 2"), std::string::npos);
    EXPECT_TRUE(report["pairs"][0]["agreement"].is_null());
    EXPECT_EQ(report["reference"]["kind"], "none");
    EXPECT_TRUE(report["variants"][0]["errors"].empty()) << "nothing to measure errors against";
    EXPECT_NE(notes().find("show the same light"), std::string::npos) << notes();
    std::vector<std::string> against_file = depths;
    against_file.insert(against_file.end(), {"--reference", "grey.exr"});
    EXPECT_EQ(compare(against_file).exit_code, 0);
    EXPECT_GT(this->report()["variants"][1]["errors"]["relmse"]["mean"], 0.0);
}

TEST_F(Compare, WhatShowsDifferentLightIsMeasuredAgainstWhatTheOthersArePooledTo) {
    ASSERT_EQ(
        compare({"--spp", "16", "--seeds", "3", "--integrators", "direct,path,normals,bdpt", "--strategies-depth", "0"})
            .exit_code,
        0);
    const json report = this->report();
    EXPECT_EQ(report["reference"]["kind"], "pooled");
    EXPECT_EQ(report["reference"]["weights"].size(), 2u);
    for (const json& pair : report["pairs"])
        EXPECT_EQ(pair["comparable"], pair["a"] == "path" && pair["b"] == "bdpt") << pair["a"] << " " << pair["b"];
    EXPECT_NE(notes().find("errors of 'direct' are against an image of different light"), std::string::npos) << notes();
    EXPECT_NE(notes().find("'normals' shows something else"), std::string::npos) << notes();
}

TEST_F(Compare, OtherScenesAreNotTested) {
    // Two environments of the same name: a world of its own for each.
    for (const char* name : {"red", "green"}) {
        fs::create_directories(work_ / name);
        ImageF sky(2, 1, 3);
        sky.pixels = {name[0] == 'r' ? 1.0f : 0.0f, name[0] == 'g' ? 1.0f : 0.0f, 0.0f,
                      name[0] == 'r' ? 1.0f : 0.0f, name[0] == 'g' ? 1.0f : 0.0f, 0.0f};
        write_image(work_ / name / "sky.exr", sky, {});
    }
    ASSERT_EQ(compare({"--spp", "4", "--seeds", "3", "--integrator", "path", "--variant",
                       "a: --environment red/sky.exr", "--variant", "b: --environment green/sky.exr"})
                  .exit_code,
              0);
    const json report = this->report();
    EXPECT_NE(report["pairs"][0]["different_light"].dump().find("the scenes"), std::string::npos);
    const json& red = report["variants"][0]["mean"];
    const json& green = report["variants"][1]["mean"];
    EXPECT_GT(red[0], red[1]);
    EXPECT_GT(green[1], green[0]);
}

TEST_F(Compare, VariantsWithoutVarianceAreAReference) {
    write_file(folder_ / "box/scene.gltf", R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
  "nodes": [{"name": "main", "camera": 0}],
  "cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}]})");
    const ProgramResult result = compare_aloud({"--spp", "4", "--seeds", "3", "--strategies-depth", "0"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err.find("nan"), std::string::npos) << result.err;
    const json report = this->report();
    EXPECT_EQ(report["reference"]["weights"], (json{{"path", 0.5}, {"bdpt", 0.5}}));
    EXPECT_EQ(report["reference"]["noise_relmse"], 0.0);
    for (const json& variant : report["variants"]) {
        EXPECT_EQ(variant["variance"], 0.0);
        EXPECT_TRUE(variant["efficiency"].is_null()) << "nothing to tell it by";
        EXPECT_EQ(variant["errors"]["relmse"]["mean"], 0.0);
    }
}

TEST_F(Compare, WithoutAReferenceOnlyWhatIsKnownIsSaid) {
    const ProgramResult result =
        compare_aloud({"--spp", "2", "--seeds", "3", "--integrator", "path", "--variant", "a: --max-depth 2",
                       "--variant", "b: --max-depth 3", "--region", "corner:0,0,4,4"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    for (const char* word : {"nan", "relMSE"}) EXPECT_EQ(result.err.find(word), std::string::npos) << result.err;
    EXPECT_NE(notes().find("no two of the variants show the same light"), std::string::npos) << notes();
    ASSERT_EQ(report()["regions"].size(), 1u) << "its mean needs no reference";
    EXPECT_GT(report()["regions"][0]["variants"][0]["mean"][0], 0.0);
    EXPECT_TRUE(report()["regions"][0]["variants"][0]["errors"].empty());
    const json luminance = report()["regions"][0]["variants"][0]["luminance"];
    ASSERT_EQ(luminance["values"].size(), 3u) << "one of each seed";
    EXPECT_GT(luminance["values"][2], 0.0);
    EXPECT_NE(result.err.find("corner, a: mean"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("no errors are known, as there is no reference\n"), std::string::npos) << result.err;
}

TEST_F(Compare, ItsHeadlineComesFirst) {
    const ProgramResult result = compare_aloud({"--time", "0.02", "--seeds", "3", "--strategies-depth", "0"});
    const std::size_t time = result.err.find("2 variants by 3 seeds take ");
    const std::size_t headline = result.err.find(report()["headline"].get<std::string>());
    ASSERT_NE(headline, std::string::npos) << result.err;
    EXPECT_LT(time, headline) << result.err;
    EXPECT_LT(headline, result.err.find("path: ")) << result.err;
    EXPECT_EQ(result.err.find("z = "), std::string::npos) << result.err;
}

TEST_F(Compare, EachPairHasItsOwnScaleOfZ) {
    ASSERT_EQ(compare({"--spp", "8", "--seeds", "3", "--integrators", "path,bdpt,naive", "--strategies-depth", "0"})
                  .exit_code,
              0);
    const json report = this->report();
    for (const char* key : {"z/path/bdpt", "z/path/naive", "z/bdpt/naive"})
        EXPECT_TRUE(report["maps"].contains(key)) << report["maps"];
    EXPECT_FALSE(report["maps"].contains("z"));
    EXPECT_TRUE(report["pairs"][0]["agreement"].contains("block_size"));
}

TEST_F(Compare, EachIntegratorSaysWhatItCannotFind) {
    const ProgramResult result = compare_aloud({"--spp", "1", "--seeds", "1", "--integrators", "path,light",
                                                "--reference-integrator", "light", "--reference-time", "0.01"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_LT(result.err.find("note: light: the environment itself is not seen"), result.err.find("path 1/1"))
        << "at start: " << result.err;
    EXPECT_NE(notes().find("the reference lacks light, as 'light' makes it: the environment itself"), std::string::npos)
        << notes();
    EXPECT_LT(result.err.find("the reference lacks light"), result.err.find("path 1/1")) << result.err;
}

TEST_F(Compare, SaysWhyAnInterruptLeftNoReference) {
    RunningProgram program({"compare", (folder_ / "box").string(), "-o", "report", "--spp", "1", "--seeds", "1",
                            "--reference-integrator", "naive", "--reference-time", "600"},
                           work_);
    // Once the last variant is rendered, the reference is.
    EXPECT_TRUE(wait_until([&] { return program.messages().find("bdpt 1/1") != std::string::npos; }));
    program.send(SIGINT);
    const ProgramResult result = program.wait();
    EXPECT_EQ(result.exit_code, 130) << result.err;
    EXPECT_EQ(report()["reference"]["kind"], "none");
    EXPECT_NE(notes().find("it was not rendered, because the comparison was interrupted"), std::string::npos)
        << notes();
}

TEST_F(Compare, MeasuresAgainstAFileOrAnotherIntegrator) {
    ASSERT_EQ(
        run_etendue({"render", (folder_ / "box").string(), "--spp", "64", "-o", "box.exr", "--float", "--quiet"}, work_)
            .exit_code,
        0);
    ASSERT_EQ(compare({"--spp", "2", "--seeds", "1", "--reference", "box.exr", "--integrators", "path"}).exit_code, 0);
    EXPECT_EQ(report()["reference"]["kind"], "file");
    EXPECT_TRUE(report()["reference"]["noise_relmse"].is_null());
    EXPECT_GT(report()["variants"][0]["errors"]["relmse"]["mean"], 0.0);
    EXPECT_EQ(report()["variants"][0]["seeds"], json{1}) << "0 is the reference's";
    EXPECT_NE(notes().find("seeds begin with 1, after those of the reference"), std::string::npos) << notes();
    ASSERT_EQ(compare({"--spp", "2", "--seeds", "1", "--reference-integrator", "bdpt", "--reference-time", "0.1",
                       "--strategies-depth", "0"})
                  .exit_code,
              0);
    const json reference = report()["reference"];
    EXPECT_EQ(reference["kind"], "integrator");
    EXPECT_GT(reference["noise_relmse"], 0.0);
    EXPECT_EQ(reference["spp"].get<int>() % 4, 0);
    const double budget = 0.1 * report()["machine"]["threads"].get<int>();
    EXPECT_NEAR(reference["cpu_seconds"].get<double>() / budget, 1.0, 0.4) << "counted as variants' time is";
    EXPECT_EQ(reference["seeds"], (json{{"first", 2}, {"count", 4}})) << "after those of the variants";
    EXPECT_NE(report()["notes"].dump().find("would not be seen"), std::string::npos)
        << "the reference is made by an algorithm under test";
}

// A file that says nothing of its noise may be as noisy as the images that are measured against it.
TEST_F(Compare, RatiosHaveNoIntervalsWhereTheReferenceMayDecideThem) {
    const std::string box = (folder_ / "box").string();
    ASSERT_EQ(run_etendue({"render", box, "--spp", "64", "-o", "box.exr", "--float", "--quiet"}, work_).exit_code, 0);
    const auto has_interval = [&](const char* spp) {
        EXPECT_EQ(compare({"--spp", spp, "--seeds", "3", "--reference", "box.exr", "--integrators", "path,naive",
                           "--strategies-depth", "0"})
                      .exit_code,
                  0);
        return !report()["pairs"][0]["intervals"]["relmse-trimmed"][0].is_null();
    };
    EXPECT_TRUE(has_interval("1"));
    // The interval of relMSE x time holds the scatter of errors and of times.
    const auto cost = [&](std::size_t variant) {
        const json of = report()["variants"][variant];
        const auto log_mean = [](const json& values) {
            return SeedValues{values.get<std::vector<double>>()}.log_mean();
        };
        return product(log_mean(of["errors"]["relmse-trimmed"]["values"]), log_mean(of["cpu_seconds"]["values"]));
    };
    const RatioInterval expected = ratio_interval(cost(0), cost(1));
    const json interval = report()["pairs"][0]["intervals"]["relmse-trimmed_time"];
    EXPECT_NEAR(interval[0].get<double>() / expected.low, 1.0, 1e-6);
    EXPECT_NEAR(interval[1].get<double>() / expected.high, 1.0, 1e-6);
    EXPECT_EQ(notes().find("the difference between the reference"), std::string::npos) << notes();
    EXPECT_FALSE(has_interval("64"));
    EXPECT_NE(notes().find("the difference between the reference and"), std::string::npos) << notes();
}

TEST_F(Compare, AReferenceFileIsLookedAtBeforeAnythingIsRendered) {
    write_grey("nan.exr", std::numeric_limits<float>::quiet_NaN());
    write_grey("infinite.exr", std::numeric_limits<float>::infinity());
    write_file(work_ / "broken.exr", "this is no EXR");
    write_image(work_ / "small.exr", ImageF(8, 8, 3), {});
    for (const auto& [file, message] :
         {std::pair{"nan.exr", "1 of its pixels are NaN or infinite, the first is (0, 0)"},
          {"infinite.exr", "1 of its pixels are NaN or infinite"},
          {"broken.exr", "broken.exr"},
          {"small.exr", "8x8"}}) {
        const ProgramResult result = compare_aloud({"--spp", "1", "--seeds", "1", "--reference", file});
        EXPECT_EQ(result.exit_code, 3) << file;
        EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
        EXPECT_EQ(result.err.find("1/1"), std::string::npos) << "rendered before: " << result.err;
    }
}

TEST_F(Compare, SaysWhichColourSpaceAReferenceIsTakenToBeIn) {
    write_grey("grey.exr");
    const ProgramResult result = compare_aloud({"--spp", "1", "--seeds", "1", "--reference", "grey.exr"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const std::string message = "'grey.exr' does not say its colour space; it is taken to be in ";
    EXPECT_LT(result.err.find(message), result.err.find("path 1/1")) << result.err;
    EXPECT_EQ(result.err.find(message), result.err.rfind(message)) << "once: " << result.err;
    EXPECT_NE(notes().find(message), std::string::npos) << notes();
}

TEST_F(Compare, TimesAreEqual) {
    ASSERT_EQ(compare({"--time", "0.4", "--seeds", "1", "--strategies-depth", "0"}).exit_code, 0);
    const json report = this->report();
    EXPECT_EQ(report["settings"]["time"], "cpu");
    EXPECT_DOUBLE_EQ(report["settings"]["seconds"], 0.4 * report["machine"]["threads"].get<int>());
    // A render by itself ends with a pass of 16 samples, some milliseconds, or within it.
    for (const json& variant : report["variants"])
        EXPECT_NEAR(variant["cpu_seconds"]["mean"].get<double>() / report["settings"]["seconds"].get<double>(), 1.0,
                    0.1);
    EXPECT_EQ(report["reference"]["kind"], "none") << "one seed cannot be pooled";
    const json& path = report["variants"][0];
    EXPECT_NEAR(path["rays_per_second"].get<double>() * path["cpu_seconds"]["mean"].get<double>(), path["rays"], 1.0);
}

TEST_F(Compare, TimesOfSeveralRendersAreCalibrated) {
    const int end = compare({"--time", "0.1", "--seeds", "3", "--strategies-depth", "0"}).exit_code;
    ASSERT_TRUE(end == 0 || end == 1) << end << ": numbers of samples, and so whether images agree, are left to chance";
    const json report = this->report();
    // A fifth of the time tells the cost of a sample within some tenths.
    for (const json& variant : report["variants"])
        EXPECT_NEAR(variant["cpu_seconds"]["mean"].get<double>() / report["settings"]["seconds"].get<double>(), 1.0,
                    0.3)
            << variant["name"];
}

TEST_F(Compare, OldNamesOfOptionsAreTheirNewOnes) {
    const ProgramResult result =
        compare_aloud({"--seconds", "0.01", "--integrators", "path", "--seeds", "1", "--reference-integrator", "direct",
                       "--reference-seconds", "0.01", "--strategies-depth", "0"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("note: --seconds is --time now\n"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("note: --reference-seconds is --reference-time now\n"), std::string::npos) << result.err;
    const json report = this->report();
    const std::string command = report["command"];
    EXPECT_NE(command.find("--time '0.01'"), std::string::npos) << command;
    EXPECT_EQ(command.find("seconds"), std::string::npos) << command;
    EXPECT_DOUBLE_EQ(report["settings"]["seconds"], 0.01 * report["machine"]["threads"].get<int>());
    const ProgramResult both = compare({"--seconds", "1", "--time", "1"});
    EXPECT_EQ(both.exit_code, 2) << both.err;
    EXPECT_EQ(compare({"--seconds", "nan"}).exit_code, 2);
}

TEST_F(Compare, SaysWhatIsWrong) {
    EXPECT_EQ(compare({"--spp", "1", "--time", "1"}).exit_code, 2);
    for (const char* number : {"nan", "inf", "-nan", "0", "-1"}) {
        EXPECT_EQ(compare({"--time", number}).exit_code, 2) << number;
        EXPECT_EQ(compare({"--reference-integrator", "path", "--reference-time", number}).exit_code, 2) << number;
    }
    EXPECT_EQ(compare({"--integrators", "path,bdpt,path"}).exit_code, 2);
    EXPECT_EQ(compare({"--region", "a:0,0,1,1", "--region", "a:1,1,2,2"}).exit_code, 2);
    for (const char* common : {"--half", "--float", "--frames=1"}) EXPECT_EQ(compare({common}).exit_code, 2) << common;
    EXPECT_EQ(compare({"--integrators", "path,magic"}).exit_code, 2);
    EXPECT_EQ(compare({"--region", "0,0,1,1"}).exit_code, 2);
    EXPECT_EQ(compare({"--reference-time", "3"}).exit_code, 2);
    const ProgramResult option = compare({"--seeds", "1", "--variant", "a: --max-dept 3"});
    EXPECT_EQ(option.exit_code, 2);
    EXPECT_NE(option.err.find("in the options of a variant, '--max-dept 3': there is no option '--max-dept' of "
                              "'render'; did you mean '--max-depth'?"),
              std::string::npos)
        << option.err;
    for (const char* own : {"--seed 3", "--spp 4", "--time 2", "--frames 1:2", "--float", "--half"}) {
        const ProgramResult result = compare({"--seeds", "1", "--variant", std::string("a: ") + own});
        EXPECT_EQ(result.exit_code, 2) << own;
        EXPECT_NE(result.err.find("is for 'render'"), std::string::npos) << result.err;
    }
    const ProgramResult help = compare({"--seeds", "1", "--variant", "a: --help"});
    EXPECT_EQ(help.exit_code, 2);
    EXPECT_NE(help.err.find("in the options of a variant, '--help': there is no option '--help'"), std::string::npos)
        << help.err;
    const ProgramResult size = compare({"--variant", "a: --size 8x8", "--variant", "b: --size 9x8"});
    EXPECT_EQ(size.exit_code, 3);
    EXPECT_NE(size.err.find("size"), std::string::npos) << size.err;
    const ProgramResult region = compare({"--region", "far:0,0,5000,10"});
    EXPECT_EQ(region.exit_code, 3);
    EXPECT_NE(region.err.find("--region: 'far'"), std::string::npos) << region.err;
    EXPECT_FALSE(fs::exists(work_ / "report/report.json"));
}

TEST_F(Compare, HelpLeavesOutWhatIsRefused) {
    const std::string help = run_etendue({"compare", "--help"}, work_).out;
    for (const char* option : {"--frames", "--half", "--float", "--seconds"})
        EXPECT_EQ(help.find(option), std::string::npos) << option;
    for (const char* option : {"--seed ", "--spp", "--time ", "--max-depth"})
        EXPECT_NE(help.find(option), std::string::npos) << option;
}

TEST_F(Compare, TheSceneMayStandAnywhere) {
    const std::string box = (folder_ / "box").string();
    for (const Names& arguments : {Names{"--integrators", "path,bdpt", box}, Names{"--region", "a:0,0,2,2", box}}) {
        Names all{"compare"};
        all.insert(all.end(), arguments.begin(), arguments.end());
        for (const char* word : {"-o", "report", "--quiet", "--spp", "1", "--seeds", "1", "--strategies-depth", "0"})
            all.emplace_back(word);
        const ProgramResult result = run_etendue(all, work_);
        EXPECT_EQ(result.exit_code, 0) << result.err;
    }
}

TEST_F(Compare, SaysBeforeRenderingThatTheReportCannotBeWritten) {
    write_file(work_ / "afile", "");
    fs::create_directories(work_ / "taken/index.html");
    fs::create_directories(work_ / "taken2/report.json");
    const std::string box = (folder_ / "box").string();
    const auto written_to = [&](const std::string& output) {
        return run_etendue({"compare", box, "-o", output, "--spp", "1", "--seeds", "1"}, work_);
    };
    EXPECT_EQ(written_to("").exit_code, 2);
    for (const auto& [output, message] : {std::pair{"afile", "cannot make the directory afile"},
                                          {"afile/report", "cannot make the directory afile/report"},
                                          {"taken", "cannot write taken/index.html: it is a directory"},
                                          {"taken2", "cannot write taken2/report.json: it is a directory"}}) {
        const ProgramResult result = written_to(output);
        EXPECT_EQ(result.exit_code, 1) << output;
        EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
        EXPECT_EQ(result.err.find("1/1"), std::string::npos) << "rendered before: " << result.err;
    }
}

}  // namespace

}  // namespace etendue::test
