// etendue profile from outside: what it writes of a small scene, and how it says what is wrong.
#include "image/read_channels.h"
#include "program/run_program.h"
#include "program/small_files.h"
#include "support/sanitizers.h"

#include <algorithm>
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

/// Puts a lamp into a scene of `write_scene`: an environment that is the same everywhere needs no shadow rays.
void add_lamp(const fs::path& directory) {
    json scene = json::parse(read_file(directory / "scene.gltf"));
    const json extension{{"KHR_lights_punctual", {{"light", 0}}}};
    scene["extensionsUsed"] = json::array({"KHR_lights_punctual"});
    scene["extensions"]["KHR_lights_punctual"]["lights"] = json::array({{{"type", "point"}, {"intensity", 100}}});
    scene["nodes"].push_back({{"extensions", extension}});
    scene["scenes"][0]["nodes"].push_back(2);
    std::ofstream(directory / "scene.gltf") << scene;
}

TEST_F(Profile, MeasuresEveryIntegratorOnEveryNumberOfThreads) {
    add_lamp(folder_ / "box");
    const ProgramResult result = profile({"--spp", "8", "--repeat", "3", "--threads", "1,2"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.out.find("path, 2 threads"), std::string::npos) << result.out;
    EXPECT_EQ(list(work_ / "out"), (Names{"heat-bdpt-2.exr", "heat-bdpt-2.png", "heat-path-2.exr", "heat-path-2.png",
                                          "index.html", "profile.csv", "profile.json", "trace.json"}));
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
    // The scene has one surface and a lamp without any.
    const json& hits = report["runs"][0]["scene_hits"];
    ASSERT_EQ(hits["materials"].size(), 1u);
    EXPECT_EQ(hits["objects"].size(), 1u);
    EXPECT_GT(hits["materials"][0]["hits"], 0);
    ASSERT_EQ(hits["lamps"].size(), 1u);
    EXPECT_EQ(hits["lamps"][0]["name"], "lights without a surface");
    for (const json& kind : report["runs"][0]["kinds"]) {
        if (kind["kind"] == "shadow") {
            EXPECT_EQ(hits["lamps"][0]["shadow_rays"], kind["rays"]);
            EXPECT_NEAR(hits["lamps"][0]["seconds"], kind["seconds"].get<double>(), 1e-9);
        }
    }
    double shading = 0.0;
    for (const json& stage : report["runs"][0]["stages"])
        for (const char* name : {"hit set-up", "textures", "material evaluation"})
            if (stage["name"] == name) shading += stage["seconds"].get<double>();
    EXPECT_NEAR(hits["materials"][0]["seconds"], shading, 1e-6) << "the only material takes all of it";
    EXPECT_GT(hits["objects"][0]["seconds"], hits["materials"][0]["seconds"]) << "rays to it are traced, too";
    EXPECT_GT(report["load"]["first_pixel_seconds"], 0.0);
    Names phases;
    for (const json& phase : report["load"]["phases"]) {
        phases.push_back(phase["name"]);
        EXPECT_GE(phase["seconds"], 0.0) << phase["name"];
    }
    EXPECT_EQ(phases, (Names{"start of the process", "files", "materials", "textures", "geometry", "BVH", "lights",
                             "light tree", "first sample of every pixel"}));
    double owned = 0.0;
    Names owners;
    for (const json& owner : report["memory"]["owners"]) {
        owners.push_back(owner["name"]);
        owned += owner["bytes"].get<double>();
        EXPECT_EQ(owner["bytes"] > 0, owner["name"] != "textures") << owner;
    }
    EXPECT_EQ(owners, (Names{"geometry", "instances", "BVH", "materials", "textures", "lights", "film",
                             "tiles and splats", "waves"}));
    EXPECT_GT(report["memory"]["peak_bytes"], owned);
    EXPECT_TRUE(report["runs"][0]["light_path_lengths"].empty());
    EXPECT_FALSE(report["runs"][2]["light_path_lengths"].empty());
    const json trace = json::parse(read_file(work_ / "out/trace.json"));
    EXPECT_FALSE(trace["traceEvents"].empty());
    const ChannelImage heat = read_channels(work_ / "out/heat-path-2.exr");
    EXPECT_EQ(heat.channel_names, (Names{"cpu_seconds", "rays"}));
    EXPECT_EQ(heat.pixels.width, 16);
    EXPECT_EQ(heat.pixels.height, 12);
    for (const float value : heat.pixels.pixels) EXPECT_GT(value, 0.0f);
}

TEST_F(Profile, NamesOnlyLampsThatThereAre) {
    write_scene(folder_ / "box", R"("lights": {"panel": {"type": "rectangle", "width": 0.5, "height": 0.5, "power": 10,
        "position": [0, 0.5, -1], "look_at": [0, 0, -2]}},)");
    ASSERT_EQ(profile({"--integrators", "path", "--threads", "1", "--spp", "16", "--repeat", "1", "--quiet"}).exit_code,
              0);
    const json hits = report()["runs"][0]["scene_hits"];
    ASSERT_EQ(hits["lamps"].size(), 1u) << hits;
    EXPECT_EQ(hits["lamps"][0]["name"], "panel");
}

// What a stamp takes is measured in the same process, so a busy machine lengthens both sides; where it does not
// lengthen them alike, another try tells.
TEST_F(Profile, TimeStampsTakeLessThanAHundredth) {
    if (kHasSanitizers) GTEST_SKIP() << "sanitizers make all else slower";
    add_lamp(folder_ / "box");
    double largest = 1.0;
    for (int tries = 0; tries < 3 && largest >= 0.01; ++tries) {
        const ProgramResult result = profile({"--spp", "16", "--repeat", "1", "--threads", "1", "--size", "256x192"});
        ASSERT_EQ(result.exit_code, 0) << result.err;
        largest = 0.0;
        for (const json& run : report()["runs"]) {
            EXPECT_GT(run["timing_share"], 0.0) << run["integrator"];
            largest = std::max(largest, run["timing_share"].get<double>());
        }
    }
    EXPECT_LT(largest, 0.01);
    for (const json& note : report()["notes"])
        EXPECT_EQ(note.get<std::string>().find("time stamps"), std::string::npos);
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
    EXPECT_NE(against("faster.json").err.find("error: path on 1 thread has become slower than in faster.json\n"),
              std::string::npos);
    std::ofstream(work_ / "broken.json") << "{\"format\": 1, \"runs\": [";
    const ProgramResult broken = against("broken.json");
    EXPECT_EQ(broken.exit_code, 3) << broken.err;
    EXPECT_NE(broken.err.find("broken.json"), std::string::npos) << broken.err;
}

TEST_F(Profile, RefusesOtherWorkBeforeAnythingIsMeasured) {
    const Names quick{"--integrators", "path", "--threads", "1", "--spp", "2", "--repeat", "2", "--quiet"};
    ASSERT_EQ(profile(quick).exit_code, 0);
    json one = report();
    for (json& run : one["runs"]) run["cpu_seconds"].erase(1);
    std::ofstream(work_ / "one.json") << one;
    const auto refuses = [&](const std::string& file, const Names& more, const std::string& message) {
        Names arguments = quick;
        arguments.insert(arguments.end(), {"--against", file});
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProgramResult result = profile(arguments, "again");
        EXPECT_EQ(result.exit_code, 3) << result.err;
        EXPECT_NE(result.err.find("error: " + file + ": "), std::string::npos) << result.err;
        EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
        EXPECT_FALSE(fs::exists(work_ / "again"));
    };
    const std::string baseline = "out/profile.json";
    refuses(baseline, {"--size", "17x12"}, "has 16 x 12 pixels, not 17 x 12");
    refuses(baseline, {"--max-depth", "9"}, "edges");
    refuses(baseline, {"--crop", "0,0,8,8"}, "the setting 'crop' differs: none in the baseline, '0 0 8 8' now");
    refuses(baseline, {"--min-depth", "2"}, "'integrator.min_depth' differs: '1' in the baseline, '2' now");
    refuses(baseline, {"--clamp-indirect", "3"}, "'clamp_indirect' differs");
    refuses(baseline, {"--bdpt-connections", "cache:5"}, "cache:5");
    refuses(baseline, {"--heuristic", "power"}, "power");
    refuses("one.json", {}, "one repetition");
    Names other = quick;
    other[1] = "bdpt";
    other.insert(other.end(), {"--against", baseline});
    EXPECT_EQ(profile(other, "again").exit_code, 3);
    write_file(folder_ / "box" / "render.json",
               read_file(folder_ / "box" / "render.json").insert(1, R"("sampler": "random",)"));
    refuses(baseline, {}, "random");
}

TEST_F(Profile, ASeedIsOnlyNoted) {
    const Names quick{"--integrators", "path", "--threads", "1", "--spp", "2", "--repeat", "2", "--quiet"};
    ASSERT_EQ(profile(quick).exit_code, 0);
    Names other = quick;
    other.insert(other.end(), {"--against", "out/profile.json", "--seed", "9", "--tolerance", "9"});
    ASSERT_EQ(profile(other, "again").exit_code, 0);
    EXPECT_EQ(report("again")["against"]["notes"][0], "another seed: '0' before, '9' now");
}

TEST_F(Profile, NotesWhatOfTheSceneIsNotMeasured) {
    write_scene(folder_ / "box", R"("error": 0.5, "robust": "mon:3", "aovs": ["depth"],)");
    ASSERT_EQ(profile({"--integrators", "path", "--threads", "1", "--spp", "2", "--repeat", "1", "--quiet"}).exit_code,
              0);
    const json report = this->report();
    // Of so little work the time stamps may take more than they should, which one more tells.
    ASSERT_GE(report["notes"].size(), 3u) << report["notes"];
    EXPECT_NE(report["notes"][0].get<std::string>().find("layers"), std::string::npos);
    EXPECT_NE(report["notes"][1].get<std::string>().find("error"), std::string::npos);
    EXPECT_NE(report["notes"][2].get<std::string>().find("median of means"), std::string::npos);
    EXPECT_EQ(report["runs"][0]["samples"], 16 * 12 * 2);
}

TEST_F(Profile, MediansOfAnEvenNumberAreMeansOfTwo) {
    ASSERT_EQ(
        profile({"--integrators", "path", "--threads", "1,2", "--spp", "2", "--repeat", "2", "--quiet"}).exit_code, 0);
    const json report = this->report();
    const json& one = report["runs"][0]["seconds"];
    const json& two = report["runs"][1]["seconds"];
    const auto sum = [](const json& times) { return times[0].get<double>() + times[1].get<double>(); };
    EXPECT_NEAR(report["runs"][1]["parallel_efficiency"].get<double>(), sum(one) / (2.0 * sum(two)), 1e-9);
}

TEST_F(Profile, ShowsEarlierProfilesOfTheSameWork) {
    const Names arguments{"--spp", "1", "--repeat", "1", "--threads", "1", "--integrators", "path", "--quiet"};
    ASSERT_EQ(profile(arguments, "before").exit_code, 0);
    Names now = arguments;
    now.insert(now.end(), {"--history", "before/profile.json"});
    ASSERT_EQ(profile(now).exit_code, 0);
    const json report = this->report();
    ASSERT_EQ(report["history"].size(), 1u);
    EXPECT_EQ(report["history"][0]["file"], "before/profile.json");
    EXPECT_EQ(report["history"][0]["runs"][0]["cpu_seconds_per_sample"],
              this->report("before")["runs"][0]["cpu_seconds_per_sample"]);
    now.insert(now.end(), {"--max-depth", "2"});
    const ProgramResult other = profile(now);
    EXPECT_EQ(other.exit_code, 3) << "of other work";
    EXPECT_NE(other.err.find("before/profile.json"), std::string::npos) << other.err;
}

TEST_F(Profile, RemovesHeatMapsOfEarlierRuns) {
    fs::create_directories(work_ / "out/heat-path-9.exr");
    for (const char* name : {"heat-bdpt-12.exr", "heat-bdpt-12.png", "heat-mine-1.exr", "heat-path-.exr",
                             "heat-path-1b.png", "heat-path-2.txt"})
        write_file(work_ / "out" / name, "");
    ASSERT_EQ(profile({"--integrators", "path", "--threads", "1", "--spp", "2", "--repeat", "1", "--quiet"}).exit_code,
              0);
    EXPECT_EQ(list(work_ / "out"),
              (Names{"heat-mine-1.exr", "heat-path-.exr", "heat-path-1.exr", "heat-path-1.png", "heat-path-1b.png",
                     "heat-path-2.txt", "heat-path-9.exr", "index.html", "profile.csv", "profile.json", "trace.json"}));
}

TEST_F(Profile, NeverOverwritesItsBaseline) {
    const Names quick{"--integrators", "path", "--threads", "1", "--spp", "2", "--repeat", "2", "--quiet"};
    ASSERT_EQ(profile(quick).exit_code, 0);
    const std::string before = read_file(work_ / "out/profile.json");
    fs::create_directory_symlink(work_ / "out", work_ / "link");
    for (const char* file : {"out/profile.json", "link/profile.json"}) {
        Names arguments = quick;
        arguments.insert(arguments.end(), {"--against", file});
        const ProgramResult result = profile(arguments);
        EXPECT_EQ(result.exit_code, 2) << result.err;
        EXPECT_NE(result.err.find("it is an input, which would be lost"), std::string::npos) << result.err;
        EXPECT_EQ(read_file(work_ / "out/profile.json"), before);
    }
}

TEST_F(Profile, SaysWhatIsWrongWithOptions) {
    const auto refuses = [&](const Names& arguments, const std::string& message) {
        const ProgramResult result = profile(arguments);
        EXPECT_EQ(result.exit_code, 2) << result.err;
        EXPECT_NE((result.out + result.err).find(message), std::string::npos) << result.out << result.err;
        EXPECT_FALSE(fs::exists(work_ / "out")) << "nothing is written";
    };
    refuses({"--spp", "4", "--time", "1"}, "cannot be given with --spp");
    refuses({"--integrators", "path,path"}, "named twice");
    refuses({"--threads", "2,2"}, "given twice");
    refuses({"--threads", "0"}, "--threads");
    refuses({"--integrators", "none"}, "none");
    refuses({"--against", "missing.json"}, "missing.json");
    refuses({"--tolerance", "0.1"}, "--against");
    write_file(work_ / "baseline.json", "{}");
    refuses({"--against", "baseline.json", "--repeat", "1"}, "--repeat 2 or more");
    for (const Names& option :
         {Names{"--integrator", "path"}, Names{"--aov", "depth"}, Names{"--aov-layout", "parts"}, Names{"--deep"},
          Names{"--robust", "mon:3"}, Names{"--error", "1"}, Names{"--no-adaptive"}, Names{"--half"}}) {
        refuses(option, option[0] + ": is for 'render'; here ");
        const ProgramResult result = profile(option);
        EXPECT_EQ(result.err.find("variant"), std::string::npos) << result.err;
    }
}

}  // namespace

}  // namespace etendue::test
