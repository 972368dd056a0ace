// etendue profile from outside: what it writes of a small scene, and how it says what is wrong.
#include "app/run_program.h"
#include "app/small_files.h"
#include "image/read_channels.h"

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace etendue::test {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Names = std::vector<std::string>;

class Profile : public testing::Test {
  protected:
    void SetUp() override {
        fs::create_directories(work_);
        write_scene(folder_ / "box");
    }
    [[nodiscard]] ProgramResult profile(std::vector<std::string> arguments, const std::string& output = "out") const {
        arguments.insert(arguments.begin(), {"profile", (folder_ / "box").string(), "-o", output});
        return run_etendue(arguments, work_);
    }
    [[nodiscard]] json report(const std::string& output = "out") const {
        return json::parse(read_file(work_ / output / "profile.json"));
    }

    TestFolder folder_;
    fs::path work_ = folder_ / "work";
};

TEST_F(Profile, MeasuresEveryIntegratorOnEveryNumberOfThreads) {
    const ProgramResult result = profile({"--spp", "8", "--repeat", "3", "--threads", "1,2"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.out.find("path, 2 threads"), std::string::npos) << result.out;
    EXPECT_EQ(list(work_ / "out"), (Names{"heat-bdpt-2.exr", "heat-bdpt-2.png", "heat-path-2.exr", "heat-path-2.png",
                                          "index.html", "profile.json", "trace.json"}));
    const json report = this->report();
    ASSERT_EQ(report["runs"].size(), 4u);
    for (const json& run : report["runs"]) {
        EXPECT_EQ(run["spp"], 8);
        EXPECT_EQ(run["seconds"].size(), 3u);
        EXPECT_EQ(run["samples"], 16 * 12 * 8);
        EXPECT_GT(run["efficiency_single"], 0.0);
        EXPECT_GE(run["efficiency_single"], run["efficiency_best"]);
        EXPECT_GT(run["parallel_efficiency"], 0.0);
        std::uint64_t rays = 0;
        for (const json& kind : run["kinds"]) {
            rays += kind["rays"].get<std::uint64_t>();
            EXPECT_GT(kind["single"], 0.0);
            EXPECT_GT(kind["packet16"], 0.0);
        }
        EXPECT_EQ(run["rays"], rays);
        EXPECT_EQ(run["hardware"]["unavailable"].is_null(), !run["hardware"]["counters"].empty());
    }
    Names kinds;
    for (const json& kind : report["runs"][2]["kinds"]) kinds.push_back(kind["kind"]);
    EXPECT_EQ(kinds, (Names{"camera", "bounce", "shadow", "light-subpath", "light-to-camera"}))
        << "its paths are too short for connections";
    EXPECT_GT(report["load"]["first_pixel_seconds"], 0.0);
    EXPECT_GT(report["memory"]["peak_bytes"], 0);
    const json trace = json::parse(read_file(work_ / "out/trace.json"));
    EXPECT_FALSE(trace["traceEvents"].empty());
    const ChannelImage heat = read_channels(work_ / "out/heat-path-2.exr");
    EXPECT_EQ(heat.channel_names, (Names{"rays", "seconds"}));
    EXPECT_EQ(heat.pixels.width, 16);
    EXPECT_EQ(heat.pixels.height, 12);
    for (const float value : heat.pixels.pixels) EXPECT_GT(value, 0.0f);
}

TEST_F(Profile, ComparesWithAnEarlierOne) {
    const Names quick{"--integrators", "path", "--threads", "1", "--spp", "4", "--repeat", "3", "--quiet"};
    ASSERT_EQ(profile(quick).exit_code, 0);
    const auto against = [&](const fs::path& file, Names more = {}) {
        Names arguments = quick;
        arguments.insert(arguments.end(), {"--against", file.string()});
        arguments.insert(arguments.end(), more.begin(), more.end());
        return profile(arguments, "again");
    };
    EXPECT_EQ(against("out/profile.json", {"--tolerance", "9"}).exit_code, 0);
    EXPECT_EQ(report("again")["against"]["runs"].size(), 1u);
    // A program that took a hundredth of the time.
    json faster = report();
    for (json& run : faster["runs"])
        for (const char* times : {"seconds", "cpu_seconds"})
            for (json& time : run[times]) time = time.get<double>() * 0.01;
    std::ofstream(work_ / "faster.json") << faster;
    EXPECT_EQ(against("faster.json").exit_code, 1);
    // Another scene.
    json other = report();
    other["scene"]["width"] = 17;
    std::ofstream(work_ / "other.json") << other;
    const ProgramResult refused = against("other.json");
    EXPECT_EQ(refused.exit_code, 3) << refused.err;
    EXPECT_NE(refused.err.find("other.json"), std::string::npos) << refused.err;
    std::ofstream(work_ / "broken.json") << "{\"format\": 1, \"runs\": [";
    const ProgramResult broken = against("broken.json");
    EXPECT_EQ(broken.exit_code, 3) << broken.err;
    EXPECT_NE(broken.err.find("broken.json"), std::string::npos) << broken.err;
}

TEST_F(Profile, SaysWhatIsWrongWithOptions) {
    const auto refuses = [&](const Names& arguments, const std::string& message) {
        const ProgramResult result = profile(arguments);
        EXPECT_EQ(result.exit_code, 2) << result.err;
        EXPECT_NE((result.out + result.err).find(message), std::string::npos) << result.out << result.err;
        EXPECT_FALSE(fs::exists(work_ / "out")) << "nothing is written";
    };
    refuses({"--spp", "4", "--seconds", "1"}, "cannot be given with --spp");
    refuses({"--integrators", "path,path"}, "named twice");
    refuses({"--threads", "2,2"}, "given twice");
    refuses({"--threads", "0"}, "--threads");
    refuses({"--integrators", "none"}, "none");
    refuses({"--against", "missing.json"}, "missing.json");
    refuses({"--tolerance", "0.1"}, "--against");
}

}  // namespace

}  // namespace etendue::test
