// What the program says to command lines and files that it cannot follow, and how its help reads.
#include "program/run_program.h"
#include "program/small_files.h"

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

namespace etendue::test {

namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

class CommandMistakes : public testing::Test {
  protected:
    CommandMistakes() {
        fs::create_directories(work_);
        write_scene(work_ / "scenes/box");
        write_file(work_ / "x.exr", "");
    }
    [[nodiscard]] ProgramResult run(const Words& words) const { return run_etendue(words, work_); }
    /// Expects that the words are refused with the exit code and one message, which says all of `said`.
    void expect_refused(const Words& words, int exit_code, const Words& said) const {
        const ProgramResult result = run(words);
        EXPECT_EQ(result.exit_code, exit_code) << fmt::format("{}: {}", fmt::join(words, " "), result.err);
        EXPECT_TRUE(result.err.starts_with("error: ")) << result.err;
        EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
        for (const std::string& part : said)
            EXPECT_NE(result.err.find(part), std::string::npos) << part << "\n" << result.err;
    }
    void expect_usage_error(const Words& words, const Words& said) const { expect_refused(words, 2, said); }

    TestFolder folder_;
    fs::path work_ = folder_ / "work";
};

TEST_F(CommandMistakes, SuggestTheOptionThatWasMeant) {
    expect_usage_error({"render", "scenes/box", "--sp", "4"}, {"no option '--sp' of 'render'; did you mean '--spp'?"});
    expect_usage_error({"batch", "scenes", "--outputt", "out"}, {"'--outputt' of 'batch'; did you mean '--output'?"});
    expect_usage_error({"render", "scenes/box", "--zzzzzzzzzzzzzzz=3"}, {"'--zzzzzzzzzzzzzzz'", "etendue help render"});
    expect_usage_error({"--versio"}, {"there is no option '--versio'; did you mean '--version'?"});
    expect_usage_error({"render", "scenes/box", "other"}, {"'other' is one word too many for 'render'"});
    expect_usage_error({"render", "scenes/box", "--out", "x.exr"}, {"no option '--out'", "did you mean '--output'?"});
}

TEST_F(CommandMistakes, SuggestTheWordThatWasMeant) {
    expect_usage_error({"render", "scenes/box", "--integrator", "bdtp"}, {"bdtp not in {", "did you mean 'bdpt'?"});
    expect_usage_error({"profile", "scenes/box", "-o", "out", "--integrators", "path,bpdt"}, {"did you mean 'bdpt'?"});
    expect_usage_error({"profile", "scenes/box", "-o", "out", "--integrators", "path", "bdpt"},
                       {"'bdpt' is one word too many", "values of --integrators: separate them by commas"});
    expect_usage_error({"profile", "scenes/box", "-o", "out", "--threads", "1", "2"}, {"--threads: separate them by"});
    EXPECT_EQ(run({"view", "x.exr", "-o", "x.png", "--bits", "12"}).err.find("did you mean"), std::string::npos);
}

TEST_F(CommandMistakes, AMissingDirectoryIsMade) {
    EXPECT_EQ(run({"render", "scenes/box", "-o", "new/folder/a.exr", "--quiet"}).exit_code, 0);
    EXPECT_TRUE(fs::exists(work_ / "new/folder/a.json"));
    EXPECT_EQ(run({"render", "scenes/box", "-o", "parts/a.partial", "--samples", "0:1", "--quiet"}).exit_code, 0);
    EXPECT_EQ(run({"view", "new/folder/a.exr", "-o", "views/a.png"}).exit_code, 0);
    EXPECT_TRUE(fs::exists(work_ / "views/a.png"));
    expect_refused({"render", "scenes/box", "-o", "x.exr/a.exr"}, 1, {"there is no directory ", "/x.exr"});
}

TEST_F(CommandMistakes, SayWhatAnOptionTakes) {
    expect_usage_error({"render", "scenes/box", "--spp"}, {"--spp needs a value behind it, INT in [1 - 16777216]"});
    expect_usage_error({"render", "scenes/box", "--seed", "-1"}, {"--seed: '-1' is not an integer in [0, 4294967295]"});
    expect_usage_error({"render", "scenes/box", "--texture-memory", "1K"}, {"'1K'", "M, G or T"});
    expect_usage_error({"render", "scenes/box", "--spp", "4", "--spp", "8"}, {"--spp is given 2 times; give it once"});
    expect_usage_error({"render", "scenes/box", "-o", ""}, {"--output: '' is not a file name"});
    expect_usage_error({"render", "scenes/box", "--samples", "0:8", "--spp", "4"},
                       {"--samples 0:8 goes beyond the 4 samples of --spp"});
    const ProgramResult memory = run({"render", "scenes/box", "--texture-memory", "8GB", "-o", "m.exr", "--quiet"});
    EXPECT_EQ(memory.exit_code, 0) << memory.err;
}

TEST_F(CommandMistakes, SayWhatIsMissing) {
    expect_usage_error({"batch", "scenes"}, {"--output is missing: Directory for the images", "etendue help batch"});
    expect_usage_error({"render"}, {"SCENE is missing: Scene directory"});
    expect_usage_error({"view", "x.exr"}, {"--output is missing: the PNG to write, such as -o x.view.png"});
    expect_usage_error({"merge", "x.exr", "-o", "y.exr"}, {"'x.exr' is an image, and an image is no part", ".partial"});
    expect_usage_error({"merge", "gone.partial", "-o", "y.exr"}, {"PARTS: there is no file 'gone.partial'"});
    expect_usage_error({"batch", "shots/*", "-o", "out"},
                       {"there is no directory 'shots/*'", "nothing that the pattern"});
    expect_usage_error({"batch", "gone.glb", "-o", "out"}, {"there is no file 'gone.glb'"});
    expect_usage_error({"render", "scenes/box", "--environment", "gone.hdr"},
                       {"--environment: there is no file 'gone.hdr'"});
    expect_refused({"render", "scenes"}, 3, {"scenes are below it, such as 'scenes/box'", "'etendue batch'"});
}

TEST_F(CommandMistakes, OfJsonAreSaidInWords) {
    const auto expect_settings_refused = [&](const std::string& settings, const std::string& said) {
        write_file(work_ / "scenes/box/render.json", settings);
        expect_refused({"render", "scenes/box"}, 3, {"render.json: not valid JSON: in line 2", said});
    };
    expect_settings_refused("{\n\"spp\": 4, // enough\n\"seed\": 3}", "a comment ('//'), which JSON does not have");
    expect_settings_refused("{\n /* enough */ \"spp\": 4}", "a comment ('/*')");
    expect_settings_refused("{\n\"spp\": 4,\n}", "a comma stands before '}'");
    expect_settings_refused("{\n\"size\": [16, 12,]}", "a comma stands before ']'");
}

TEST_F(CommandMistakes, AreToldApartFromWhatCanBeDone) {
    const ProgramResult still = run({"render", "scenes/box", "--animation", "Run", "--spp", "1", "-o", "still.png"});
    EXPECT_EQ(still.exit_code, 0) << still.err;
    EXPECT_NE(still.err.find("--animation: the file has no animation, and the scene stands still"), std::string::npos)
        << still.err;
    EXPECT_TRUE(fs::exists(work_ / "still.png"));
    EXPECT_TRUE(fs::exists(work_ / "still.exr"));
}

TEST_F(CommandMistakes, OldNamesGoOnWorkingWithANote) {
    write_file(work_ / "scenes/box/render.json", R"({"resolution": [20, 10], "spp": 1})");
    const ProgramResult result = run({"render", "scenes/box", "-o", "old.exr"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("'resolution' is called 'size' now"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("old.exr: 20x10, 1 spp"), std::string::npos) << result.err;
}

TEST_F(CommandMistakes, SeveralScenesAreInspectedAtOnce) {
    write_scene(work_ / "scenes/other");
    write_file(work_ / "scenes/other/render.json", R"({"size": [16, 12], "spp": 2, "camera": "front"})");
    const ProgramResult all = run({"inspect", "scenes"});
    EXPECT_EQ(all.exit_code, 3);
    for (const char* part : {"== scenes/box\n", "image: 16x12 pixels, 2 samples per pixel, auto, camera 'main'",
                             "there is no camera 'front'", "== 2 scenes, 1 with errors\n"})
        EXPECT_NE(all.out.find(part), std::string::npos) << part << "\n" << all.out;
    EXPECT_EQ(run({"inspect", "scenes", "--camera", "main", "--spp", "7"}).exit_code, 0);
    EXPECT_EQ(run({"inspect", "scenes/box", "--aov", "dept"}).exit_code, 3);
    write_file(work_ / "scenes/other/scene.gltf", "{");
    const std::string broken = run({"inspect", "scenes/other"}).out;
    EXPECT_TRUE(broken.starts_with("error: ")) << "nothing but the error: " << broken;
}

TEST_F(CommandMistakes, HelpIsInGroupsAndFits) {
    const std::string help = run({"batch", "--help"}).out;
    for (const char* group : {"\nWhich images:\n", "\nHow they are made:\n", "\nWhat is said:\n",
                              "\nLight transport:\n", "\nColour:\n", "\nAnimation:\n", "\nLayers and files:\n"})
        EXPECT_NE(help.find(group), std::string::npos) << group;
    constexpr std::size_t kWidth = 100;
    std::istringstream lines(help.substr(0, help.find("Examples:")));
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), kWidth) << line;
    EXPECT_NE(help.find("--retries INT in [0 - 1000]\n"), std::string::npos) << help;
    EXPECT_NE(help.find("(default: 1)"), std::string::npos);
    EXPECT_NE(help.find("Leave the ground of the studio out (not with --ground)\n"), std::string::npos) << help;
    EXPECT_NE(help.find("--jobs-memory SIZE      "), std::string::npos) << "what it needs stands in its sentence";
    EXPECT_NE(run({"diff", "--help"}).out.find("--map-max FLOAT > 0"), std::string::npos);
    EXPECT_NE(run({"profile", "--help"}).out.find("--growth INT in [100 - 10000000]\n"), std::string::npos);
}

}  // namespace

}  // namespace etendue::test
