// The program from outside: exit codes, files, and what it prints.
#include "program/run_program.h"
#include "program/small_files.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>
#include <sys/wait.h>

namespace etendue::test {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Names = std::vector<std::string>;

class CommandLine : public testing::Test {
  protected:
    void SetUp() override { fs::create_directories(work_); }
    [[nodiscard]] ProgramResult run(const std::vector<std::string>& arguments) const {
        return run_etendue(arguments, work_);
    }
    /// Written beside the working directory, so that `list(work_)` shows what the program made.
    std::string scene(const std::string& name, const std::string& extra = "") const {
        write_scene(folder_ / ("scenes/" + name), extra);
        return (folder_ / ("scenes/" + name)).string();
    }
    [[nodiscard]] std::string scenes() const { return (folder_ / "scenes").string(); }

    TestFolder folder_;
    fs::path work_ = folder_ / "work";
};

TEST_F(CommandLine, HelpHasExamplesForEachCommand) {
    const ProgramResult top = run({"--help"});
    EXPECT_EQ(top.exit_code, 0);
    for (const char* word : {"render", "batch", "inspect", "diff", "compare", "merge", "submit", "Examples:", "130"})
        EXPECT_NE(top.out.find(word), std::string::npos) << word;
    for (const char* command : {"render", "batch", "inspect", "diff", "compare", "merge", "submit"}) {
        const ProgramResult help = run({command, "--help"});
        EXPECT_EQ(help.exit_code, 0);
        EXPECT_NE(help.out.find("Examples:"), std::string::npos) << command;
        EXPECT_NE(help.out.find(std::string("  etendue ") + command), std::string::npos) << command;
    }
    const ProgramResult render_help = run({"render", "--help"});
    for (const char* option :
         {"--integrator", "--spp",           "--size",    "--crop",      "--camera",       "--threads",
          "--seed",       "--time",          "--quality", "--max-depth", "--environment",  "--exposure",
          "--view",       "--working-space", "--half",    "--float",     "--frames",       "--fps",
          "--force",      "--quiet",         "--json",    "--min-depth", "--light-samples"})
        EXPECT_NE(render_help.out.find(option), std::string::npos) << option;
    EXPECT_EQ(run({"--version"}).exit_code, 0);
    EXPECT_TRUE(list(work_).empty());
}

TEST_F(CommandLine, SaysWhichInstructionSetRunsAndTakesNoOther) {
    const std::string said = run({"--version"}).out;
    const std::size_t begin = said.find('(');
    ASSERT_NE(begin, std::string::npos) << said;
    const std::string set = said.substr(begin + 1, said.find(')') - begin - 1);
    ::setenv("ETENDUE_ISA", set.c_str(), 1);
    ProgramResult result = run({"render", scene("box"), "--spp", "1", "--size", "8x8", "-o", "a.exr"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(json::parse(read_file(work_ / "a.json")).at("instruction_set"), set);
    ::setenv("ETENDUE_ISA", "avx3", 1);
    result = run({"--version"});
    ::unsetenv("ETENDUE_ISA");
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find("ETENDUE_ISA is 'avx3'; it can be 'sse4', 'avx2' or 'avx512'"), std::string::npos)
        << result.err;
}

/// Gives the buffer of a scene of `write_scene` another name.
void name_buffer(const fs::path& directory, const std::string& name) {
    json scene = json::parse(read_file(directory / "scene.gltf"));
    scene["buffers"][0]["uri"] = name;
    write_file(directory / "scene.gltf", scene.dump());
    fs::rename(directory / "triangle.bin", directory / name);
}

TEST_F(CommandLine, OutputsReplaceNoInput) {
    const fs::path box = scene("box");
    name_buffer(box, "t.depth.exr");
    ASSERT_EQ(run({"render", box, "--quiet", "-o", "sky.exr"}).exit_code, 0);
    fs::create_symlink("sky.exr", work_ / "link.exr");
    fs::create_hard_link(work_ / "sky.exr", work_ / "second.exr");
    const std::string parts = "part.partial";
    ASSERT_EQ(run({"render", box, "--samples", "0:1", "--quiet", "-o", parts}).exit_code, 0);
    fs::create_directory(work_ / "out");
    for (const char* name : {"report.json", "profile.json", "heat-path-1.png"})
        fs::copy(work_ / "sky.exr", work_ / "out" / name);
    const std::string settings = box / "render.json";
    const std::string buffer = box / "t.depth.exr";
    struct Case {
        std::vector<std::string> arguments;
        std::string input;
    };
    for (const Case& c :
         {Case{{"render", box, "--environment", "sky.exr", "-o", "sky.exr"}, "sky.exr"},
          {{"render", box, "--environment", "sky.exr", "-o", "link.exr"}, "sky.exr"},
          {{"render", box, "--environment", "sky.exr", "-o", "second.exr"}, "sky.exr"},
          {{"render", box, "-o", box / "render.exr"}, settings},
          {{"render", box, "-o", box / "t.exr", "--aov", "depth", "--aov-layout", "files"}, buffer},
          {{"render", box, "-o", "a.exr", "--integrator", "bdpt", "--strategies-image", buffer}, buffer},
          {{"view", "sky.png", "-o", "./sky.png"}, "sky.png"},
          {{"denoise", "sky.exr", "-o", "sky.exr"}, "sky.exr"},
          {{"diff", "sky.exr", "sky.exr", "--map", "sky.exr"}, "sky.exr"},
          {{"merge", parts, "-o", parts}, parts},
          {{"compare", box, "--reference", "out/report.json", "-o", "out"}, "out/report.json"},
          {{"compare", box, "--environment", "out/report.json", "-o", "out"}, "out/report.json"},
          {{"profile", box, "--environment", "out/profile.json", "-o", "out"}, "out/profile.json"},
          {{"profile", box, "--environment", "out/heat-path-1.png", "-o", "out"}, "out/heat-path-1.png"},
          {{"batch", box, "--no-probe", "-o", box.parent_path()}, box.parent_path() / "box.json"}}) {
        if (c.arguments.front() == "batch") {
            // The image would replace the settings of another scene.
            write_scene(box.parent_path() / "other");
            name_buffer(box.parent_path() / "other", "t.bin");
            fs::rename(box.parent_path() / "other/render.json", box.parent_path() / "box.json");
            fs::create_symlink("../box.json", box.parent_path() / "other/render.json");
        }
        const std::string before = read_file(work_ / c.input);
        std::vector<std::string> arguments = c.arguments;
        if (arguments.front() == "batch") arguments[1] = box.parent_path();
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 2) << fmt::format("{}: {}", fmt::join(c.arguments, " "), result.err);
        EXPECT_NE(result.err.find("it is an input, which would be lost"), std::string::npos) << result.err;
        EXPECT_NE(result.err.find(c.arguments.front() == "diff" ? "error: --map would replace" : "error: --"),
                  std::string::npos)
            << result.err;
        EXPECT_TRUE(read_file(work_ / c.input) == before) << c.input;
    }
    EXPECT_FALSE(fs::exists(work_ / "a.exr"));
}

TEST_F(CommandLine, OutputsReplaceNoColourConfig) {
    const std::string box = scene("box");
    write_file(
        work_ / "c.json",
        "ocio_profile_version: 2\nsearch_path: .\nroles: {scene_linear: ref, default: ref}\n"
        "file_rules:\n  - !<Rule> {name: Default, colorspace: ref}\n"
        "displays:\n  d:\n    - !<View> {name: v, colorspace: ref}\ncolorspaces:\n  - !<ColorSpace> {name: ref}\n"
        "  - !<ColorSpace> {name: a, from_scene_reference: !<FileTransform> {src: lut.png}}\n");
    write_file(work_ / "lut.png", "a table");
    ::setenv("OCIO", (work_ / "c.json").c_str(), 1);
    for (const char* image : {"c.exr", "lut.exr"}) {
        const ProgramResult result = run({"render", box, "-o", image});
        EXPECT_EQ(result.exit_code, 2) << result.err;
    }
    const ProgramResult view = run({"view", "any.exr", "-o", "lut.png"});
    ::unsetenv("OCIO");
    EXPECT_EQ(view.exit_code, 2) << view.err;
    EXPECT_EQ(list(work_), (Names{"c.json", "lut.png"}));
    EXPECT_EQ(read_file(work_ / "lut.png"), "a table");
}

TEST_F(CommandLine, AnImageReplacesNoLayerOfAnother) {
    const std::string box = scene("box");
    ASSERT_EQ(run({"render", box, "--quiet", "-o", "a.exr", "--deep"}).exit_code, 0);
    const ProgramResult result = run({"render", box, "--quiet", "-o", "a.deep.exr"});
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_NE(result.err.find("a.deep.exr is a layer of the image a.exr"), std::string::npos) << result.err;
}

TEST_F(CommandLine, WhatCannotBePrintedIsAnError) {
    const std::string box = scene("box");
    const std::string error_file = work_ / "err";
    for (const std::string& command :
         {std::string("--version"), std::string("--help"), std::string("help render"), std::string("render --help"),
          "inspect --json " + box, "inspect " + box, "batch --dry-run --no-probe --json -o out " + scenes()})
        // A descriptor that is closed goes to no other file either.
        for (const auto& [where, why] :
             {std::pair{"/dev/full", "No space left on device"}, std::pair{"&-", "Bad file descriptor"}}) {
            const int status = std::system(fmt::format("cd {} && {} {} >{} 2>{}", work_.string(),
                                                       program_file().string(), command, where, error_file)
                                               .c_str());
            EXPECT_EQ(WEXITSTATUS(status), 1) << command;
            EXPECT_NE(read_file(error_file).find(fmt::format("error: cannot write to standard output: {}", why)),
                      std::string::npos)
                << command << ": " << read_file(error_file);
        }
}

TEST_F(CommandLine, AFileThatMayNotGrowIsAnErrorAndNoSignal) {
    for (const auto& [command, code] :
         {std::pair{"--help > out 2> /dev/null", 1}, std::pair{"render --help > out 2> /dev/null", 1},
          std::pair{"--bogus 2> out", 2}, std::pair{"denoise nope -o d.exr 2> out", 2}}) {
        const int status = std::system(fmt::format("cd '{}' && bash -c \"ulimit -f 0 && exec '{}' {}\"", work_.string(),
                                                   program_file().string(), command)
                                           .c_str());
        EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == code) << command << ": " << status;
    }
}

TEST_F(CommandLine, NamesFromFilesDoNothingToTheTerminal) {
    const fs::path box = scene("box");
    json scene = json::parse(read_file(box / "scene.gltf"));
    const std::string name = "a\x1b]0;x\x07\nerror: fake\xc2\x9b\xe2\x80\xae";
    for (const char* list : {"nodes", "meshes"}) scene[list][0]["name"] = name;
    scene["materials"] = json::array({{{"name", name}}});
    scene["extensionsUsed"] = json::array({"EXT_" + name});
    write_file(box / "scene.gltf", scene.dump());
    const auto expect_harmless = [](const std::string& text) {
        for (const char* harm : {"\x1b", "\x07", "\nerror: fake", "\xc2\x9b", "\xe2\x80\xae"})
            EXPECT_EQ(text.find(harm), std::string::npos) << text;
    };
    const ProgramResult inspected = run({"inspect", box});
    EXPECT_EQ(inspected.exit_code, 0) << inspected.out << inspected.err;
    expect_harmless(inspected.out + inspected.err);
    EXPECT_NE(inspected.out.find(R"(material 0 "a\x1b]0;x\x07\x0aerror: fake\u{9b}\u{202e}")"), std::string::npos)
        << inspected.out;
    EXPECT_EQ(json::parse(run({"inspect", box, "--json"}).out).at("materials").at(0), name)
        << "exact where programs read";
    const ProgramResult unknown = run({"render", box, "--camera", "b" + name});
    EXPECT_EQ(unknown.exit_code, 3);
    expect_harmless(unknown.err);
    fs::rename(box, box.parent_path() / "a\x1b[2J");
    const ProgramResult planned = run({"batch", "--dry-run", "--no-probe", "-o", "out", scenes()});
    EXPECT_EQ(planned.exit_code, 0);
    expect_harmless(planned.out + planned.err);
    const std::string typed = this->scene("typed", R"("integrator": {"type": "path\nerror: fake"},)");
    for (const std::vector<std::string>& arguments :
         {Names{"inspect", typed}, Names{"batch", "--dry-run", "--no-probe", "-o", "out", typed}}) {
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 3) << result.err;
        expect_harmless(result.out + result.err);
        EXPECT_NE(result.out.find("path\\x0aerror: fake"), std::string::npos) << result.out;
    }
}

TEST_F(CommandLine, FilesHaveTheDateOfTheEnvironment) {
    const std::string box = scene("box");
    ::setenv("SOURCE_DATE_EPOCH", "86400", 1);
    for (const char* image : {"a.exr", "b.exr"})
        EXPECT_EQ(run({"render", box, "--quiet", "--deep", "-o", image}).exit_code, 0);
    ::setenv("SOURCE_DATE_EPOCH", "yesterday", 1);
    const ProgramResult wrong = run({"--version"});
    ::unsetenv("SOURCE_DATE_EPOCH");
    EXPECT_EQ(wrong.exit_code, 2);
    EXPECT_NE(wrong.err.find("SOURCE_DATE_EPOCH is 'yesterday'"), std::string::npos) << wrong.err;
    for (const char* name : {".exr", ".deep.exr", ".png"})
        EXPECT_TRUE(read_file(work_ / ("a" + std::string(name))) == read_file(work_ / ("b" + std::string(name))))
            << name;
    EXPECT_NE(read_file(work_ / "a.exr").find("1970:01:02 00:00:00"), std::string::npos);
}

TEST_F(CommandLine, UsageErrorsEndWithTwo) {
    const std::string box = scene("box");
    const std::vector<std::vector<std::string>> bad = {{},
                                                       {"paint"},
                                                       {"render"},
                                                       {"render", box, "--speed"},
                                                       {"render", box, "--spp", "0"},
                                                       {"render", box, "--size", "12"},
                                                       {"render", box, "-o", "image.jpg"},
                                                       {"render", box, "--threads", "0"},
                                                       {"batch", scenes()},
                                                       {"batch", "no-such-directory", "-o", "out"},
                                                       {"inspect"},
                                                       {"inspect", box, "--spq", "4"}};
    for (const auto& arguments : bad) {
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 2) << (arguments.empty() ? "" : arguments.back()) << "\n" << result.err;
        EXPECT_FALSE(result.err.empty());
    }
    EXPECT_TRUE(list(work_).empty());
}

TEST_F(CommandLine, RenderWritesThreeFilesAndNothingElse) {
    const ProgramResult result = run({"render", scene("box"), "-o", "image.exr"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(list(work_), (Names{"image.exr", "image.json", "image.png"}));
    const json statistics = json::parse(read_file(work_ / "image.json"));
    EXPECT_EQ(statistics["complete"], true);
    EXPECT_EQ(statistics["samples"], 16 * 12 * 2);
    EXPECT_EQ(statistics["size"], (json{16, 12}));
    EXPECT_TRUE(result.out.empty()) << result.out;
    EXPECT_NE(result.err.find("image.exr"), std::string::npos) << result.err;
}

TEST_F(CommandLine, TheSceneNamesTheImageByDefault) {
    EXPECT_EQ(run({"render", scene("box"), "--quiet"}).exit_code, 0);
    EXPECT_EQ(list(work_), (Names{"box.exr", "box.json", "box.png"}));
}

TEST_F(CommandLine, QuietPrintsNothingAndJsonOnlyJson) {
    const std::string box = scene("box");
    const ProgramResult quiet = run({"render", box, "--quiet"});
    EXPECT_EQ(quiet.out + quiet.err, "");
    const ProgramResult with_json = run({"render", box, "--quiet", "--json", "--spp", "5", "--seed", "3"});
    EXPECT_EQ(with_json.err, "");
    const json statistics = json::parse(with_json.out);
    EXPECT_EQ(statistics["spp"]["done"], 5);
    EXPECT_EQ(statistics["rays"]["camera"], 16 * 12 * 5);
    EXPECT_EQ(json::parse(read_file(work_ / "box.json")), statistics);
}

TEST_F(CommandLine, AMissingCameraAndLightAreAddedAndSaid) {
    const std::string box = scene("box");
    write_file(box + "/render.json", R"({"size": [8, 8], "spp": 1})");
    std::string text = read_file(box + "/scene.gltf");
    text.replace(text.find(", \"camera\": 0"), 13, "");
    write_file(box + "/scene.gltf", text);
    const ProgramResult result = run({"render", box});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_NE(result.err.find("camera"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("environment"), std::string::npos) << result.err;
}

TEST_F(CommandLine, InvalidScenesAndSettingsEndWithThree) {
    const std::string box = scene("box");
    const ProgramResult camera = run({"render", box, "--camera", "mian"});
    EXPECT_EQ(camera.exit_code, 3);
    EXPECT_NE(camera.err.find("'main'"), std::string::npos) << camera.err;
    EXPECT_NE(camera.err.find("--camera"), std::string::npos) << "where it was said: " << camera.err;
    const ProgramResult crop = run({"render", box, "--crop", "0,0,100,100"});
    EXPECT_EQ(crop.exit_code, 3);
    EXPECT_NE(crop.err.find("--crop: the crop window"), std::string::npos) << crop.err;
    const ProgramResult view = run({"render", box, "--view", "Sepia"});
    EXPECT_EQ(view.exit_code, 3);
    EXPECT_NE(view.err.find("--view"), std::string::npos) << view.err;
    EXPECT_NE(view.err.find("Un-tone-mapped"), std::string::npos) << "what there is: " << view.err;
    const ProgramResult depths = run({"render", box, "--min-depth", "4", "--max-depth", "3"});
    EXPECT_EQ(depths.exit_code, 3);
    EXPECT_NE(depths.err.find("--min-depth: min_depth 4 is above max_depth 3"), std::string::npos) << depths.err;
    const ProgramResult strategy = run({"render", box, "--integrator", "path", "--strategy", "1,2"});
    EXPECT_EQ(strategy.exit_code, 3);
    EXPECT_NE(strategy.err.find("--strategy: 'path' has no strategies"), std::string::npos) << strategy.err;
    EXPECT_EQ(run({"render", box, "--working-space", "no-such-space"}).exit_code, 3);
    EXPECT_EQ(run({"render", folder_.path().string() + "/nowhere"}).exit_code, 3);
    EXPECT_EQ(run({"inspect", folder_.path().string() + "/nowhere"}).exit_code, 3);
    const ProgramResult key = run({"render", scene("typo", R"("ssp": 4,)")});
    EXPECT_EQ(key.exit_code, 3);
    EXPECT_NE(key.err.find("spp"), std::string::npos) << key.err;
    EXPECT_NE(key.err.find("/ssp"), std::string::npos) << key.err;
    EXPECT_TRUE(list(work_).empty());
}

TEST_F(CommandLine, SettingsAreBlamedWhereTheyStand) {
    const auto error_of = [&](const std::string& name, const std::string& settings) {
        const ProgramResult rendered = run({"render", scene(name, settings)});
        EXPECT_EQ(rendered.exit_code, 3);
        EXPECT_EQ(run({"inspect", scene(name, settings)}).exit_code, 3) << "found without rendering";
        return rendered.err;
    };
    EXPECT_NE(error_of("a", R"("integrator": {"type": "pth"},)").find("render.json#/integrator/type: no integrator"),
              std::string::npos);
    EXPECT_NE(error_of("b", R"("crop": [0, 0, 100, 100],)").find("render.json#/crop: the crop window"),
              std::string::npos);
    EXPECT_NE(error_of("c", R"("color": {"view": "nope"},)").find("render.json#/color/view: there is no view"),
              std::string::npos);
    EXPECT_NE(error_of("d", R"("color": {"display": "nope"},)").find("render.json#/color/display: there is no display"),
              std::string::npos);
    EXPECT_NE(error_of("e", R"("aovs": ["nope"],)").find("render.json#/aovs/0: layer 'nope'"), std::string::npos);
    EXPECT_NE(error_of("f", R"("frames": [0, 1],)").find("scene.gltf: the file has no animation"), std::string::npos);
}

TEST_F(CommandLine, UnknownCommandsAreNamed) {
    const ProgramResult result = run({"rendr", "x"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find("'rendr'; did you mean 'render'?"), std::string::npos) << result.err;
}

TEST_F(CommandLine, LightThatCannotBeFoundIsSaid) {
    const std::string box = scene("box");
    EXPECT_EQ(run({"render", box, "--integrator", "naive"}).err.find("by chance"), std::string::npos);
    std::string text = read_file(box + "/scene.gltf");
    text.replace(text.find("\"nodes\": [0, 1]"), 15, "\"nodes\": [0, 1, 2]");
    text.replace(text.find(", \"camera\": 0}]"), 15,
                 R"(, "camera": 0}, {"extensions": {"KHR_lights_punctual": {"light": 0}}}],
  "extensionsUsed": ["KHR_lights_punctual"], "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point"}]}})");
    write_file(box + "/scene.gltf", text);
    const ProgramResult naive = run({"render", box, "--integrator", "naive"});
    EXPECT_NE(naive.err.find("never met by chance"), std::string::npos) << naive.err;
    EXPECT_EQ(run({"render", box}).err.find("cannot be found"), std::string::npos);
    write_file(box + "/scene.gltf", text.replace(text.find("\"POSITION\": 0}"), 14, "\"POSITION\": 0}, \"material\": 0")
                                        .replace(text.find("\"cameras\":"), 0, R"("materials": [{"pbrMetallicRoughness":
  {"roughnessFactor": 0}}],
  )"));
    const ProgramResult path = run({"render", box});
    EXPECT_NE(path.err.find("caustics"), std::string::npos) << path.err;
}

/// Outputs that cannot be written are found before anything is rendered.
TEST_F(CommandLine, StrategiesAreShownOneByOne) {
    const std::string box = scene("box");
    const ProgramResult result =
        run({"render", box, "--integrator", "bdpt", "--spp", "1", "--strategies-image", "all.exr", "-o", "image.exr"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("--strategies-depth"), std::string::npos) << "longer paths are left out: " << result.err;
    EXPECT_EQ(list(work_), (Names{"all.exr", "all.png", "image.exr", "image.json", "image.png"}));
    const ProgramResult few = run({"render", box, "--integrator", "bdpt", "--spp", "1", "--max-depth", "2",
                                   "--strategies-image", "few.exr", "--strategies-unweighted", "-o", "image.exr"});
    EXPECT_EQ(few.exit_code, 0) << few.err;
    EXPECT_EQ(few.err.find("note"), std::string::npos) << few.err;
    const std::string bytes = read_file(work_ / "few.exr");
    for (const char* part : {"s0t2", "s0t3", "s1t2", "s2t1"}) EXPECT_NE(bytes.find(part), std::string::npos) << part;
    EXPECT_EQ(bytes.find("s0t4"), std::string::npos);
    // With and without weights they are two images of one name.
    const std::vector<std::string> weighted{
        "render", box,         "--integrator",       "bdpt",    "--spp",   "1", "--max-depth", "2",
        "-o",     "image.exr", "--strategies-image", "few.exr", "--resume"};
    EXPECT_EQ(run(weighted).exit_code, 0);
    const std::string again = read_file(work_ / "few.exr");
    EXPECT_NE(again, bytes);
    EXPECT_EQ(json::parse(read_file(work_ / "image.json"))["strategies_image"],
              (json{{"file", "few.exr"}, {"longest", 2}, {"weighted", true}}));
    EXPECT_NE(run(weighted).err.find("image.exr: up to date"), std::string::npos);
    EXPECT_EQ(run({"render", box, "--integrator", "bdpt", "--strategies-image", "all.png"}).exit_code, 2);
    EXPECT_EQ(run({"render", box, "--strategies-depth", "3"}).exit_code, 2);
    const ProgramResult path = run({"render", box, "--integrator", "path", "--strategies-image", "path.exr"});
    EXPECT_EQ(path.exit_code, 3);
    EXPECT_NE(path.err.find("--strategies-image: 'path' has no strategies"), std::string::npos) << path.err;
}

/// The pyramid must not be written over the image, by whatever name.
TEST_F(CommandLine, ThePyramidIsNotWrittenOverTheImage) {
    const std::string box = scene("box");
    fs::create_directories(work_ / "sub");
    fs::create_directory_symlink(work_, work_ / "sub/link");
    fs::create_symlink("image.exr", work_ / "dangling.exr");
    fs::create_symlink("image.png", work_ / "picture.png");
    fs::create_symlink(work_ / "image.json", work_ / "text.png");
    const Names before = list(work_);
    const auto refused = [&](const std::string& pyramid, const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"render", box, "--integrator",       "bdpt",
                                           "--spp",  "1", "--strategies-image", pyramid};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 2) << pyramid << ": " << result.err;
        for (const char* option : {"--strategies-image", "--output"})
            EXPECT_NE(result.err.find(option), std::string::npos) << pyramid << ": " << result.err;
        EXPECT_EQ(list(work_), before) << pyramid;
    };
    for (const std::string& pyramid :
         {std::string("image.exr"), std::string("./image.exr"), std::string("sub/../image.exr"),
          (work_ / "image.exr").string(), std::string("sub/link/image.exr"), std::string("dangling.exr"),
          std::string("picture.exr"), std::string("text.exr")})
        refused(pyramid, {"-o", "image.exr"});
    refused("image.exr", {"-o", "dangling.exr"});
    refused("./box.exr", {});
    // The same name elsewhere is another file.
    const ProgramResult other = run({"render", box, "--integrator", "bdpt", "--spp", "1", "--max-depth", "2",
                                     "--strategies-image", "sub/image.exr", "-o", "image.exr", "--quiet", "--no-png"});
    EXPECT_EQ(other.exit_code, 0) << other.err << " and an image without a PNG has none to write over";
    EXPECT_TRUE(fs::exists(work_ / "sub/image.exr"));
}

TEST_F(CommandLine, PyramidsThatCannotBeMadeAreRefusedBeforeRendering) {
    const std::string box = scene("box");
    const auto refused = [&](int exit_code, const Names& words, const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"render", box, "--integrator",       "bdpt",
                                           "--spp",  "1", "--strategies-image", "pyramid.exr"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, exit_code) << result.err;
        for (const std::string& word : words) EXPECT_NE(result.err.find(word), std::string::npos) << result.err;
        EXPECT_TRUE(list(work_).empty());
    };
    refused(2, {"--strategies-image", "--strategies-depth", "--min-depth of 9"}, {"--min-depth", "9"});
    refused(2, {"--strategies-depth", "--min-depth of 4"}, {"--min-depth", "4", "--strategies-depth", "3"});
    // 4 billion pixels of 44 strategies.
    refused(1, {"--strategies-image", "44 strategies of 65536x65536", "GiB", "--size", "--strategies-depth"},
            {"--size", "65536x65536"});
    const std::string shallow = scene("shallow", R"("integrator": {"min_depth": 9},)");
    const ProgramResult result = run({"render", shallow, "--integrator", "bdpt", "--strategies-image", "pyramid.exr"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find("render.json#/integrator/min_depth"), std::string::npos) << result.err;
}

TEST_F(CommandLine, WhatCannotBeWrittenEndsWithOneAtOnce) {
    fs::create_directories(folder_ / "directory.exr");
    std::ofstream(folder_ / "file") << "no directory";
    for (const std::string& output : {(folder_ / "file/image.exr").string(), (folder_ / "directory.exr").string()}) {
        const ProgramResult result = run({"render", scene("box"), "--spp", "1000000", "-o", output});
        EXPECT_EQ(result.exit_code, 1);
        EXPECT_NE(result.err.find(output), std::string::npos) << result.err;
    }
    EXPECT_TRUE(list(work_).empty());
}

// A pipe without a reader would fail, or wait, after all is rendered.
TEST_F(CommandLine, PipesAreNoOutputs) {
    const std::string box = scene("box");
    const fs::path pipes = folder_ / "pipes";
    fs::create_directories(pipes);
    for (const char* name : {"a.exr", "b.png", "c.json", "d.partial", "report.json", "profile.json", "night.log"})
        ASSERT_EQ(::mkfifo((pipes / name).c_str(), 0600), 0);
    const auto expect_refused = [&](const std::vector<std::string>& words, const char* pipe) {
        const ProgramResult result = run(words);
        EXPECT_EQ(result.exit_code, 1) << pipe;
        EXPECT_NE(result.err.find(fmt::format("{}: it is a pipe", pipe)), std::string::npos) << result.err;
    };
    for (const auto& [output, pipe] : {std::pair{"a.exr", "a.exr"}, std::pair{"b.exr", "b.png"},
                                       std::pair{"c.exr", "c.json"}, std::pair{"d.partial", "d.partial"}})
        expect_refused({"render", box, "--spp", "1000000", "-o", pipes / output}, pipe);
    expect_refused({"batch", box, "--spp", "1000000", "-o", pipes}, "report.json");
    expect_refused({"batch", box, "--spp", "1000000", "-o", "out", "--log", pipes / "night.log"}, "night.log");
    expect_refused({"compare", box, "--spp", "1000000", "-o", pipes}, "report.json");
    expect_refused({"profile", box, "--spp", "1000000", "-o", pipes}, "profile.json");
    ASSERT_EQ(run({"render", box, "--quiet", "-o", "image.exr"}).exit_code, 0);
    expect_refused({"view", "image.exr", "-o", pipes / "b.png"}, "b.png");
    expect_refused({"denoise", "image.exr", "-o", pipes / "a.exr"}, "a.exr");
}

TEST_F(CommandLine, InterruptsWriteWhatThereIs) {
    for (const auto& [signal, code] : {std::pair{SIGINT, 130}, std::pair{SIGTERM, 143}}) {
        ProgramResult result;
        // Later and later, since on a busy machine there may be no sample before.
        for (int milliseconds = 300; milliseconds < 60'000 && !fs::exists(work_ / "image.exr"); milliseconds *= 2)
            result = run_etendue({"render", scene("box"), "--spp", "10000000", "-o", "image.exr"}, work_,
                                 [milliseconds, signal = signal](int pid) {
                                     std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
                                     kill(pid, signal);
                                 });
        EXPECT_EQ(result.exit_code, code) << result.err;
        EXPECT_EQ(list(work_), (Names{"image.checkpoint", "image.exr", "image.json", "image.png"}));
        fs::remove(work_ / "image.checkpoint");
        const json statistics = json::parse(read_file(work_ / "image.json"));
        EXPECT_EQ(statistics["complete"], false);
        EXPECT_EQ(statistics["halt_reason"], "interrupted");
        EXPECT_LT(statistics["spp"]["done"], statistics["spp"]["requested"]);
        EXPECT_NE(read_file(work_ / "image.exr").find("interrupted"), std::string::npos);
        fs::remove(work_ / "image.exr");
    }
}

TEST_F(CommandLine, TheTimeLimitEndsTheRenderInOrder) {
    const ProgramResult result = run({"render", scene("box"), "--spp", "10000000", "--time", "0.2", "-o", "image.exr"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const json statistics = json::parse(read_file(work_ / "image.json"));
    EXPECT_EQ(statistics["halt_reason"], "time limit");
    EXPECT_GT(statistics["spp"]["done"], 0);
}

/// The results of a sequence by image, from its JSON summary.
std::vector<std::string> frame_results(const ProgramResult& result) {
    std::vector<std::string> lines;
    for (const json& row : json::parse(result.out))
        lines.push_back(fs::path(row["image"].get<std::string>()).stem().string() + ": " +
                        row["result"].get<std::string>());
    return lines;
}

/// The results of a batch by image, from its report: of what was tried.
std::vector<std::string> batch_results(const ProgramResult& result) {
    std::vector<std::string> lines;
    const json report = json::parse(result.out);
    for (const json& unit : report["units"])
        if (unit["outcome"] != "not started")
            lines.push_back(fs::path(unit["image"].get<std::string>()).stem().string() + ": " +
                            unit["outcome"].get<std::string>());
    return lines;
}

/// The images in the output directory of a batch, by the files that belong to them.
Names batch_images(const fs::path& output) {
    Names files = list(output);
    for (const char* book : {"index.html", "ledger.jsonl", "report.json"})
        EXPECT_EQ(std::erase(files, book), 1u) << book;
    return files;
}

TEST_F(CommandLine, BatchSkipsWhatIsUpToDate) {
    const std::string one = scene("one");
    (void)scene("two");
    const std::vector<std::string> batch = {"batch",   scenes(), "-o",         "out",
                                            "--quiet", "--json", "--no-probe", "--in-process"};
    const auto run_with = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments = batch;
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return batch_results(result);
    };
    const Names rendered = {"one: rendered", "two: rendered"};
    const Names skipped = {"one: up to date", "two: up to date"};
    EXPECT_EQ(run_with({}), rendered);
    EXPECT_EQ(list(work_).front(), "out");
    EXPECT_EQ(batch_images(work_ / "out"), (Names{"one.exr", "one.json", "one.png", "two.exr", "two.json", "two.png"}));
    EXPECT_EQ(run_with({}), skipped);
    EXPECT_EQ(run_with({"--force"}), rendered);
    EXPECT_EQ(run_with({"--seed", "8"}), rendered);
    EXPECT_EQ(run_with({"--seed", "8"}), skipped);
    fs::last_write_time(one + "/triangle.bin", fs::file_time_type::clock::now() + std::chrono::seconds(2));
    EXPECT_EQ(run_with({"--seed", "8"}), skipped) << "another time is not another content";
    std::string settings = read_file(one + "/render.json");
    settings.back() = ' ';
    write_file(one + "/render.json", settings + "}");
    EXPECT_EQ(run_with({"--seed", "8"}), (Names{"one: rendered", "two: up to date"}));
}

TEST_F(CommandLine, BatchGoesOnAfterABrokenScene) {
    (void)scene("a");
    write_file(scene("b") + "/scene.gltf", "{ broken");
    (void)scene("nested/c");
    const ProgramResult result = run({"batch", scenes(), "-o", "out"});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.err.find("scenes/b"), std::string::npos) << result.err;
    // The table names all three.
    for (const char* text : {"rendered", "failed", "nested/c"})
        EXPECT_NE(result.out.find(text), std::string::npos) << result.out;
    EXPECT_EQ(batch_images(work_ / "out"),
              (Names{"a.exr", "a.json", "a.png", "nested", "nested/c.exr", "nested/c.json", "nested/c.png"}));
    EXPECT_EQ(batch_results(run({"batch", scenes(), "-o", "out", "--json", "--quiet"})),
              (Names{"a: up to date", "b: failed", "c: up to date"}));
}

TEST_F(CommandLine, BatchFindsScenesInsideScenesAndEachOnce) {
    const std::string outer = scene("outer");
    (void)scene("outer/inner");
    const ProgramResult result = run_etendue(
        {"batch", ".", outer, "-o", (work_ / "out").string(), "--quiet", "--json", "--no-probe"}, fs::path(outer));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(batch_results(result), (Names{"outer: rendered", "inner: rendered"}));
    EXPECT_EQ(batch_images(work_ / "out"),
              (Names{"inner.exr", "inner.json", "inner.png", "outer.exr", "outer.json", "outer.png"}));
}

TEST_F(CommandLine, FramesAreImagesOfTheirMoments) {
    const std::string box = animated_scene(scene("box"));
    const ProgramResult result = run({"render", box, "--frames", "-1:3:2", "--fps", "3"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(list(work_), (Names{"box.-0001.exr", "box.-0001.json", "box.-0001.png", "box.0001.exr", "box.0001.json",
                                  "box.0001.png", "box.0003.exr", "box.0003.json", "box.0003.png"}));
    EXPECT_NE(result.err.find("[2/3] box frame 1"), std::string::npos) << result.err;
    const json first = json::parse(read_file(work_ / "box.0001.json"));
    EXPECT_EQ(first["frame"], 1);
    EXPECT_EQ(first["time_code"], 1.0 / 3.0);
    // The same moment as one image; before the first key and at rest it is the same.
    EXPECT_EQ(run({"render", box, "--time-code", "1", "-o", "end.exr", "--quiet"}).exit_code, 0);
    EXPECT_EQ(run({"render", box, "-o", "rest.exr", "--quiet"}).exit_code, 0);
    EXPECT_EQ(read_file(work_ / "box.0003.png"), read_file(work_ / "end.png"));
    EXPECT_EQ(read_file(work_ / "box.-0001.png"), read_file(work_ / "rest.png"));
    EXPECT_NE(read_file(work_ / "box.-0001.png"), read_file(work_ / "end.png"));
}

TEST_F(CommandLine, NotesSayWhichOptionsHaveNoEffect) {
    const std::string box = scene("box");
    const std::vector<std::string> cached{"render", box, "--integrator",       "bdpt",
                                          "--spp",  "1", "--bdpt-connections", "cache:2"};
    EXPECT_EQ(run(cached).err.find("cache:2"), std::string::npos);
    (void)animated_scene(box);
    std::vector<std::string> moving = cached;
    moving.insert(moving.end(), {"--time-code", "0", "--shutter", "0:1"});
    const ProgramResult result = run(moving);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("note: connections to a cache (cache:2) have no effect"), std::string::npos)
        << result.err;
    moving.emplace_back("--quiet");
    EXPECT_EQ(run(moving).err.find("cache:2"), std::string::npos);
}

TEST_F(CommandLine, LightSamplesReachTheIntegratorsThatSplitThem) {
    const std::string box = scene("box");  // an even environment is all its light
    for (const char* integrator : {"path", "direct"}) {
        const ProgramResult result =
            run({"render", box, "--integrator", integrator, "--spp", "1", "--light-samples", "3"});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_NE(result.err.find("note: 3 light samples have no effect: no light is sampled here"), std::string::npos)
            << integrator << ": " << result.err;
    }
}

TEST_F(CommandLine, FramesSayOnceWhatIsTrueOfAll) {
    const std::string box = animated_scene(scene("box"));
    const ProgramResult result =
        run({"render", box, "--frames", "0:1", "--integrator", "path", "--spp", "1", "--light-samples", "3"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const std::string note = "note: 3 light samples have no effect";
    const std::size_t first = result.err.find(note);
    ASSERT_NE(first, std::string::npos) << result.err;
    EXPECT_EQ(result.err.find(note, first + 1), std::string::npos) << result.err;
}

TEST_F(CommandLine, FinishedFramesAreNotRenderedAgain) {
    const std::string box = animated_scene(scene("box", R"("frames": [0, 1],)"));
    const auto results = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"render", box, "--quiet", "--json", "-o", "a.###.exr"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return frame_results(result);
    };
    EXPECT_EQ(results({}), (Names{"a.0000: rendered", "a.0001: rendered"}));
    EXPECT_EQ(results({"--frames", "0:2"}), (Names{"a.0000: up to date", "a.0001: up to date", "a.0002: rendered"}));
    EXPECT_EQ(results({"--frames", "2", "--force"}), (Names{"a.0002: rendered"}));
    write_file(work_ / "a.0003.checkpoint", "damaged");
    const ProgramResult refused =
        run({"render", box, "--quiet", "--json", "-o", "a.###.exr", "--frames", "3:4", "--resume"});
    EXPECT_EQ(refused.exit_code, 3);
    EXPECT_EQ(frame_results(refused), (Names{"a.0003: failed", "a.0004: rendered"})) << refused.err;
    EXPECT_NE(refused.err.find("a.0003.checkpoint"), std::string::npos) << refused.err;
    // Motion vectors and headers have the rate.
    EXPECT_EQ(results({"--fps", "25"}), (Names{"a.0000: rendered", "a.0001: rendered"}));
    const ProgramResult batch = run({"batch", scenes(), "-o", "out", "--quiet", "--json", "--no-probe"});
    EXPECT_EQ(batch_results(batch), (Names{"box.0000: rendered", "box.0001: rendered"})) << batch.err;
}

TEST_F(CommandLine, AnInterruptBetweenFramesKeepsThoseBefore) {
    const std::string box = animated_scene(scene("box"));
    const ProgramResult result = run_etendue({"render", box, "--frames", "0:9999", "--quiet"}, work_, [this](int pid) {
        for (int i = 0; i < 1000 && !fs::exists(work_ / "box.0001.json"); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        kill(pid, SIGINT);
    });
    EXPECT_EQ(result.exit_code, 130) << result.err;
    EXPECT_EQ(json::parse(read_file(work_ / "box.0001.json"))["complete"], true);
    EXPECT_LT(list(work_).size(), 3000u);
}

TEST_F(CommandLine, FramesOfAStillSceneAreAnError) {
    const std::string box = scene("box");
    const ProgramResult still = run({"render", box, "--frames", "0:1"});
    EXPECT_EQ(still.exit_code, 3);
    EXPECT_NE(still.err.find("no animation"), std::string::npos) << still.err;
    const ProgramResult batch = run({"batch", scenes(), "-o", "out", "--frames", "0:9", "--json", "--no-probe"});
    EXPECT_EQ(batch.exit_code, 1);
    EXPECT_EQ(batch_results(batch), (Names{"box.0000: failed"})) << "the others are not tried";
    EXPECT_TRUE(batch_images(work_ / "out").empty());
}

TEST_F(CommandLine, BatchOfNothingIsAnError) {
    fs::create_directories(scenes());
    EXPECT_EQ(run({"batch", scenes(), "-o", "out"}).exit_code, 3);
}

TEST_F(CommandLine, InspectTellsWhatWasLoadedAndRendersNothing) {
    const std::string box = scene("box");
    const ProgramResult text = run({"inspect", box});
    EXPECT_EQ(text.exit_code, 0) << text.err;
    EXPECT_NE(text.out.find("triangles: 1"), std::string::npos) << text.out;
    const json inspected = json::parse(run({"inspect", box, "--json"}).out);
    EXPECT_EQ(inspected["triangles"], 1);
    EXPECT_EQ(inspected["cameras"], json{"main"});
    EXPECT_EQ(inspected["bounds"]["min"], (json{-1.0, -1.0, -2.0}));
    EXPECT_TRUE(list(work_).empty());
}

TEST_F(CommandLine, EnvironmentsMayComeFromDirectoriesThatAreNamed) {
    ASSERT_EQ(::unsetenv("ETENDUE_ASSETS"), 0);
    const std::string box = scene("box");
    std::ofstream(fs::path(box) / "render.json") << R"({"size": [4, 4], "environment": {"image": "sky.hdr"}})";
    fs::create_directories(work_ / "skies");
    std::ofstream(work_ / "skies/sky.hdr", std::ios::binary)
        << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\x80\x80\x80\x81\x80\x80\x80\x81";
    const ProgramResult refused = run({"inspect", box});
    EXPECT_EQ(refused.exit_code, 3);
    EXPECT_NE(refused.out.find("--assets DIR names a directory"), std::string::npos) << refused.out;
    EXPECT_EQ(run({"inspect", box, "--assets", "skies"}).exit_code, 0);
    EXPECT_EQ(run({"render", box, "--assets", "skies", "--spp", "1", "-o", "sky.exr"}).exit_code, 0);
    EXPECT_EQ(run({"inspect", box, "--assets", "nowhere"}).exit_code, 2);
}

TEST_F(CommandLine, InspectReportsEveryProblem) {
    const std::string broken = scene("broken", R"("ssp": 4, "samplre": "sobol",)");
    const ProgramResult result = run({"inspect", broken, "--json"});
    EXPECT_EQ(result.exit_code, 3);
    int errors = 0;
    const json inspected = json::parse(result.out);
    for (const json& problem : inspected["problems"]) errors += problem["severity"] == "error" ? 1 : 0;
    EXPECT_EQ(errors, 2) << result.out;
}

TEST_F(CommandLine, MissingTexturesAreWarningsOrErrors) {
    const std::string box = scene("box");
    name_missing_texture(box);
    const ProgramResult rendered = run({"render", box, "--spp", "1", "-o", "a.exr"});
    EXPECT_EQ(rendered.exit_code, 0) << rendered.err;
    EXPECT_NE(rendered.err.find("scene.gltf#/images/0: image file 'missing.hdr': the file does not exist"),
              std::string::npos)
        << rendered.err;
    EXPECT_EQ(json::parse(read_file(work_ / "a.json")).at("missing_textures"), 1);
    EXPECT_EQ(json::parse(run({"inspect", box, "--json"}).out).at("missing_textures"), 1);
    for (const char* command : {"render", "inspect"}) {
        const ProgramResult refused = run({command, box, "--missing-textures", "error"});
        EXPECT_EQ(refused.exit_code, 3) << command << refused.err;
    }
}

}  // namespace

}  // namespace etendue::test
