// etendue batch as a user runs it: several at once, killed, out of memory, interrupted.
#include "program/run_program.h"
#include "program/small_files.h"
#include "support/sanitizers.h"

#include <algorithm>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>
#include <unistd.h>

namespace etendue::test {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Names = std::vector<std::string>;

class Batch : public testing::Test {
  protected:
    void SetUp() override {
        fs::create_directories(work_);
        // AddressSanitizer would make an ordinary end of a crash.
        const char* const options = getenv("ASAN_OPTIONS");
        const std::string given = options == nullptr ? "" : std::string(options) + ":";
        setenv("ASAN_OPTIONS", (given + "handle_segv=0").c_str(), 1);
    }

    void add_scene(const std::string& name, const std::string& extra = "") const {
        write_scene(folder_ / ("scenes/" + name), extra);
    }
    /// A scene that takes at least so many seconds.
    void add_slow_scene(const std::string& name, double seconds) const {
        add_scene(name);
        write_file(folder_ / ("scenes/" + name + "/render.json"),
                   fmt::format(R"({{"size": [16, 12], "spp": 10000000, "time": {}, "environment": {{}}}})", seconds));
    }
    [[nodiscard]] Names arguments(const Names& more = {}) const {
        Names all{"batch", (folder_ / "scenes").string(), "-o", "out", "--no-probe"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    [[nodiscard]] ProgramResult run(const Names& more = {}) const { return run_etendue(arguments(more), work_); }
    [[nodiscard]] std::unique_ptr<RunningProgram> start(const Names& more = {}) const {
        return std::make_unique<RunningProgram>(arguments(more), work_);
    }

    /// The ledger's events of this kind.
    [[nodiscard]] std::vector<json> events(const std::string& kind) const {
        std::vector<json> found;
        if (!fs::exists(work_ / "out/ledger.jsonl")) return found;
        std::istringstream text(read_file(work_ / "out/ledger.jsonl"));
        for (std::string line; std::getline(text, line);) {
            // The last line may be on its way.
            json event = json::parse(line, nullptr, false);
            if (event.is_object() && event["event"] == kind) found.push_back(std::move(event));
        }
        return found;
    }
    /// How often each unit has such an event.
    [[nodiscard]] std::map<std::string, int> count(const std::string& kind) const {
        std::map<std::string, int> counts;
        for (const json& event : events(kind)) ++counts[event["unit"].get<std::string>()];
        return counts;
    }
    /// The process that renders for the batch, once it is ready for signals. Throws if there is none: a signal to
    /// process 0 would go to these tests.
    [[nodiscard]] static int child_of(const RunningProgram& batch) {
        int child = 0;
        const bool found = wait_until([&] {
            const std::vector<int> children = children_of(batch.pid());
            child = children.empty() ? 0 : children.front();
            // Until its exec it is a copy of the batch, handlers and all, and the batch waits for it. The batch itself
            // has its own command only once it has children: before its exec it is a copy of these tests.
            return (child != 0 && command_of(child) != command_of(batch.pid()) && handles_interrupt(child)) ||
                   batch.has_ended();
        });
        if (!found || child == 0) throw std::runtime_error("no process renders for the batch: " + batch.messages());
        return child;
    }
    /// Waits for its end, which has this exit code; what it wrote tells why, if not.
    static void expect_end(RunningProgram& program, int exit_code) {
        const ProgramResult result = program.wait();
        EXPECT_EQ(result.exit_code, exit_code) << result.err;
    }
    /// Nothing is left but images and what tells of them.
    void expect_tidy() const {
        for (const std::string& name : list(work_ / "out")) {
            const std::string extension = fs::path(name).extension().string();
            EXPECT_TRUE(std::set<std::string>({".exr", ".png", ".json", ".jsonl", ".html"}).contains(extension) ||
                        fs::is_directory(work_ / "out" / name))
                << name;
            EXPECT_NE(fs::path(name).filename().string().front(), '.') << name;
        }
    }

    TestFolder folder_;
    fs::path work_ = folder_ / "work";
};

TEST_F(Batch, RendersEachImageInAProcessOfItsOwnAndTellsOfIt) {
    add_scene("a");
    add_scene("b/c");
    const ProgramResult result = run();
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(list(work_ / "out"), (Names{"a.exr", "a.json", "a.png", "b", "b/c.exr", "b/c.json", "b/c.png",
                                          "index.html", "ledger.jsonl", "report.json"}));
    EXPECT_NE(result.err.find("2 of 2 images to render: 2 never rendered"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("[2/2] b/c: rendered in"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("  b/c: auto chose "), std::string::npos) << result.err;
    EXPECT_EQ(count("unit finished"), (std::map<std::string, int>{{"a", 1}, {"b/c", 1}}));
    EXPECT_EQ(events("batch finished").front()["rendered"], 2);
    const json report = json::parse(read_file(work_ / "out/report.json"));
    EXPECT_EQ(report["totals"]["rendered"], 2);
    EXPECT_EQ(report["units"][0]["spp"], 2);
    EXPECT_EQ(report["units"][0]["reason"], "never rendered");
    EXPECT_FALSE(report["ended"].is_null());
    const ProgramResult again = run({"--json", "--quiet"});
    EXPECT_EQ(again.err, "");
    EXPECT_EQ(json::parse(again.out), json::parse(read_file(work_ / "out/report.json")));
    EXPECT_EQ(json::parse(again.out)["totals"]["up_to_date"], 2);
}

TEST_F(Batch, PassesOnHowToRender) {
    add_scene("a");
    const Names how{"--spp",     "3",       "--size",     "20x10", "--seed",   "7",    "--crop",
                    "1,2,6,9",   "--float", "--exposure", "-1.5",  "--camera", "main", "--max-depth=5",
                    "--threads", "1"};
    const ProgramResult result = run(how);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const json statistics = json::parse(read_file(work_ / "out/a.json"));
    EXPECT_EQ(statistics["spp"]["done"], 3);
    EXPECT_EQ(statistics["full_size"], (json{20, 10}));
    EXPECT_EQ(statistics["size"], (json{5, 7}));
    EXPECT_EQ(statistics["threads"], 1);
    // What the other process was told is what this one meant.
    const ProgramResult again = run(how);
    EXPECT_NE(again.err.find("all up to date"), std::string::npos) << again.err;
}

TEST_F(Batch, ADryRunPrintsThePlanAndWritesNothing) {
    add_scene("a");
    add_scene("b");
    Names dry = arguments({"--dry-run"});
    std::erase(dry, "--no-probe");
    const ProgramResult table = run_etendue(dry, work_);
    EXPECT_EQ(table.exit_code, 0) << table.err;
    EXPECT_NE(table.out.find("never rendered"), std::string::npos) << table.out;
    EXPECT_NE(table.out.find("2 of 2 images to render, about "), std::string::npos) << table.out;
    EXPECT_TRUE(list(work_).empty());
    EXPECT_EQ(run({"--quiet"}).exit_code, 0);
    const Names before = list(work_);
    const json plan = json::parse(run({"--dry-run", "--json", "--seed", "3"}).out);
    EXPECT_EQ(plan["stale"], 2);
    EXPECT_EQ(plan["units"][1]["reason"], "settings changed: seed: 0 -> 3");
    EXPECT_EQ(run({"--dry-run", "--seed", "3", "--log", "log"}).exit_code, 0);
    EXPECT_TRUE(plan["units"][1]["estimated_seconds"].is_null());
    EXPECT_EQ(list(work_), before);
}

TEST_F(Batch, ADryRunSaysWhatWillFail) {
    add_scene("a");
    add_scene("b", R"("spq": 3,)");
    add_scene("c");
    write_file(folder_ / "scenes/c/render.json", R"({"size": [16, 12], "spp": 2, "camera": "front"})");
    add_scene("d");
    write_file(folder_ / "scenes/d/scene.gltf", "{");
    for (const bool probes : {true, false}) {
        Names dry = arguments({"--dry-run"});
        if (probes) std::erase(dry, "--no-probe");
        const ProgramResult result = run_etendue(dry, work_);
        EXPECT_EQ(result.exit_code, 3) << result.err;
        for (const char* said :
             {"unknown key 'spq'; did you mean 'spp'?", "there is no camera 'front'; there are 'main'",
              "scenes/d/scene.gltf: not valid JSON", "; 3 will fail\n", "16x12", probes ? "path" : "auto", "main"})
            EXPECT_NE(result.out.find(said), std::string::npos) << said << "\n" << result.out;
        EXPECT_TRUE(list(work_).empty());
    }
    EXPECT_EQ(run({"--dry-run", "--only", "a"}).exit_code, 0);
}

TEST_F(Batch, AMissingTextureLeavesItsTrace) {
    add_scene("a");
    (void)animated_scene((folder_ / "scenes/a").string());
    name_missing_texture(folder_ / "scenes/a");
    for (const bool probes : {true, false}) {
        Names dry = arguments({"--dry-run", "--frames", "1:2"});
        if (probes) std::erase(dry, "--no-probe");
        const std::string table = run_etendue(dry, work_).out;
        const std::size_t first = table.find("missing.hdr");
        ASSERT_NE(first, std::string::npos) << table;
        EXPECT_EQ(table.find("missing.hdr", table.find('\n', first)), std::string::npos) << "once: " << table;
    }
    const ProgramResult result = run({"--quiet", "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const json unit = json::parse(result.out)["units"][0];
    EXPECT_NE(unit["warnings"].dump().find("missing.hdr"), std::string::npos) << unit;
    EXPECT_EQ(json::parse(read_file(work_ / "out/a.json"))["warnings"], unit["warnings"]);
    const ProgramResult again = run();
    EXPECT_NE(again.out.find("1 up to date in "), std::string::npos) << again.out;
    EXPECT_NE(again.out.find("; 1 with warnings; out/index.html\n"), std::string::npos) << again.out;
}

TEST_F(Batch, SaysWhatItReplacesByFewerSamples) {
    add_scene("a");
    EXPECT_EQ(run({"--spp", "4"}).exit_code, 0);
    const std::string said = "1 finished image will be replaced by one with fewer samples\n";
    EXPECT_NE(run({"--spp", "2", "--dry-run"}).out.find(said), std::string::npos);
    EXPECT_NE(run({"--spp", "2"}).err.find(said), std::string::npos);
    EXPECT_EQ(run({"--spp", "4"}).err.find("will be replaced"), std::string::npos);
}

TEST_F(Batch, AnErrorThatIsNotReachedLeavesItsTrace) {
    add_scene("a");
    const ProgramResult result = run({"--error", "0.000001", "--spp", "8"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const json unit = json::parse(read_file(work_ / "out/report.json"))["units"][0];
    EXPECT_EQ(unit["halt_reason"], "samples done");
    EXPECT_EQ(unit["relative_error_requested"], 0.000001);
    EXPECT_NE(unit["warnings"].dump().find("the error 1e-06 was not reached"), std::string::npos) << unit;
    EXPECT_NE(result.out.find("/1e-06  out/a.exr\n"), std::string::npos) << result.out;
}

TEST_F(Batch, ARenderJsonAboveScenesIsForNone) {
    add_scene("a");
    write_file(folder_ / "scenes/render.json", R"({"spp": 3})");
    const ProgramResult result = run({"--dry-run"});
    EXPECT_EQ(result.exit_code, 3) << result.err;
    EXPECT_NE(result.out.find("render.json: this file belongs beside a glTF file, and there is none; scenes below"),
              std::string::npos)
        << result.out;
    EXPECT_EQ(result.out.find("etendue batch"), std::string::npos) << "that is what it is";
}

TEST_F(Batch, OptionsThatFitNoSceneAreSaidOnce) {
    add_scene("a");
    add_scene("b");
    const auto with_probe = [&](Names more) {
        more.insert(more.begin(), {"batch", (folder_ / "scenes").string(), "-o", "out"});
        return run_etendue(more, work_);
    };
    for (const Names& wrong : {Names{"--display", "none"}, Names{"--aov", "dept"}, Names{"--only", "z"},
                               Names{"--exclude", "z"}, Names{"--exclude", "*"}, Names{"--name", "{shot}"},
                               Names{"--order", "longest", "--no-probe"}, Names{"--log", "no/log"}}) {
        const ProgramResult result = with_probe(wrong);
        EXPECT_EQ(result.exit_code, 2) << wrong[1] << result.err;
        EXPECT_TRUE(result.err.starts_with("error: --")) << result.err;
        EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
        EXPECT_TRUE(list(work_).empty());
    }
    const ProgramResult camera =
        with_probe({"--camera", "front", "--on-finish", "echo $ETENDUE_FAILED $ETENDUE_EXIT_CODE > finished"});
    EXPECT_EQ(camera.exit_code, 2) << camera.err;
    EXPECT_TRUE(events("unit started").empty()) << "no scene has it";
    EXPECT_EQ(count("unit failed"), (std::map<std::string, int>{{"a", 1}, {"b", 1}}));
    EXPECT_EQ(json::parse(read_file(work_ / "out/report.json"))["totals"]["failed"], 2);
    EXPECT_EQ(read_file(work_ / "finished"), "2 2\n");
    EXPECT_EQ(json::parse(run({"--failed", "--dry-run", "--json"}).out)["stale"], 2);
}

TEST_F(Batch, WhatIsToFollowFollowsAnyEnd) {
    fs::create_directories(folder_ / "scenes");
    const auto end_of = [&](const Names& more) {
        Names all{"--on-finish", "echo $ETENDUE_EXIT_CODE > finished", "--log", "out/night.log"};
        all.insert(all.end(), more.begin(), more.end());
        const int code = run(all).exit_code;
        EXPECT_EQ(read_file(work_ / "finished"), fmt::format("{}\n", code));
        return code;
    };
    EXPECT_EQ(end_of({}), 3) << "there are no scenes";
    EXPECT_NE(read_file(work_ / "out/night.log").find("no scene directory"), std::string::npos);
    add_scene("a");
    EXPECT_EQ(end_of({"--failed"}), 0) << "none has";
    EXPECT_EQ(end_of({"--display", "none"}), 2);
    EXPECT_EQ(end_of({"gone"}), 2) << "a directory on a disk that is not mounted";
    fs::remove_all(work_ / "out");
    fs::create_directories(work_ / "out/ledger.jsonl");
    EXPECT_EQ(end_of({}), 1) << "nothing can be written there";
}

TEST_F(Batch, EachCameraIsLookedAt) {
    add_scene("a");
    const fs::path file = folder_ / "scenes/a/scene.gltf";
    json scene = json::parse(read_file(file));
    scene["cameras"].push_back(scene["cameras"][0]);
    scene["cameras"].back()["name"] = "top";
    scene["nodes"].push_back({{"camera", scene["cameras"].size() - 1}});
    scene["scenes"][0]["nodes"].push_back(scene["nodes"].size() - 1);
    // A second scene of the file without the first camera.
    scene["scenes"].push_back({{"name", "other"}, {"nodes", {0, scene["nodes"].size() - 1}}});
    write_file(file, scene.dump());
    const json plan = json::parse(run({"--cameras", "all", "--dry-run", "--json"}).out);
    ASSERT_EQ(plan["units"].size(), 2u);
    EXPECT_EQ(plan["units"][0]["camera"], "main");
    EXPECT_EQ(plan["units"][1]["camera"], "top");
    const json other = json::parse(run({"--cameras", "all", "--dry-run", "--json", "--scene", "other"}).out);
    ASSERT_EQ(other["units"].size(), 1u);
    EXPECT_EQ(other["units"][0]["camera"], "top");
}

TEST_F(Batch, ShowsWhatIsRunningAndWhenItEnds) {
    add_slow_scene("a", 2.0);
    add_scene("b");
    const auto batch = start({"--threads", "1"});
    json report;
    ASSERT_TRUE(wait_until([&] {
        if (!fs::exists(work_ / "out/report.json")) return false;
        report = json::parse(read_file(work_ / "out/report.json"));
        return report["units"][0]["fraction"].is_number() || batch->has_ended();
    }));
    EXPECT_EQ(report["state"], "running");
    EXPECT_EQ(report["units"][0]["outcome"], "running");
    EXPECT_EQ(report["totals"]["running"], 1);
    EXPECT_EQ(report["units"][1]["outcome"], "not started");
    EXPECT_TRUE(report["ended"].is_null());
    EXPECT_NE(read_file(work_ / "out/index.html").find("\"running\""), std::string::npos);
    expect_end(*batch, 0);
    report = json::parse(read_file(work_ / "out/report.json"));
    EXPECT_EQ(report["state"], "ended");
    EXPECT_TRUE(report["units"][0]["fraction"].is_null());
}

TEST_F(Batch, KeepsTheSumsOfRendersOfMoreThanAMinute) {
    add_slow_scene("a", 1000.0);
    const auto option_of_child = [&](const Names& more) {
        const auto batch = start(more);
        const std::string command = command_of(child_of(*batch));
        batch->send(SIGINT);
        expect_end(*batch, 130);
        const std::string option = std::string("\0--keep-sums-after", 18) + '\0';
        const std::size_t found = command.find(option);
        if (found == std::string::npos) return std::string("none");
        return command.substr(found + option.size(), command.find('\0', found + option.size()) - found - option.size());
    };
    EXPECT_EQ(option_of_child({}), "60");
    EXPECT_EQ(option_of_child({"--no-keep-sums", "--force"}), "none");
}

TEST_F(Batch, GoesOnFromTheSumsOfAFinishedImage) {
    add_scene("a");
    EXPECT_EQ(run({"--keep-sums", "--float"}).exit_code, 0);
    EXPECT_TRUE(fs::exists(work_ / "out/a.sums"));
    EXPECT_NE(run({"--float", "--time", "60"}).err.find("1 image, all up to date"), std::string::npos);
    const ProgramResult plan = run({"--float", "--spp", "8", "--dry-run"});
    EXPECT_NE(plan.out.find("spp: 2 -> 8, goes on from its sums"), std::string::npos) << plan.out;
    const std::string scene = (folder_ / "scenes/a").string();
    const ProgramResult more =
        run_etendue({"render", scene, "--float", "--spp", "8", "-o", "out/a.exr", "--resume"}, work_);
    EXPECT_NE(more.err.find("going on after 2 of 8 samples"), std::string::npos) << more.err;
    EXPECT_FALSE(fs::exists(work_ / "out/a.sums"));
    const json statistics = json::parse(read_file(work_ / "out/a.json"));
    EXPECT_EQ(statistics["spp"]["done"], 8);
    EXPECT_GT(statistics["before"]["rays"], 0);
    EXPECT_LT(statistics["before"]["rays"], statistics["rays"]["total"]);
    const ProgramResult anew =
        run_etendue({"render", scene, "--float", "--spp", "8", "-o", "anew.exr", "--quiet"}, work_);
    EXPECT_EQ(anew.exit_code, 0) << anew.err;
    const ProgramResult difference = run_etendue({"diff", "out/a.exr", "anew.exr", "--json"}, work_);
    EXPECT_EQ(json::parse(difference.out)["measures"]["mse"]["value"], 0.0) << difference.out;
    // Sums of another render are of no use, and no obstacle.
    EXPECT_EQ(run({"--keep-sums", "--float", "--spp", "4", "--force"}).exit_code, 0);
    EXPECT_EQ(run({"--float", "--spp", "8", "--seed", "3"}).exit_code, 0);
}

TEST_F(Batch, MakesWhatIsChosenAndTellsOfItWhereItIsAsked) {
    add_scene("a");
    add_scene("b", R"("spq": 3,)");
    const ProgramResult result =
        run({"--cameras", "all", "--no-png", "--name", "{scene}/{camera}", "--log", "log", "--on-finish",
             "echo $ETENDUE_RENDERED $ETENDUE_FAILED $ETENDUE_EXIT_CODE > finished"});
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_EQ(read_file(work_ / "finished"), "1 1 1\n");
    EXPECT_NE(read_file(work_ / "log").find("  [1/2] a camera main: rendered in "), std::string::npos);
    EXPECT_TRUE(fs::exists(work_ / "out/a/main.exr"));
    EXPECT_FALSE(fs::exists(work_ / "out/a/main.png"));
    const json unit = json::parse(read_file(work_ / "out/report.json"))["units"][0];
    EXPECT_EQ(unit["camera"], "main");
    EXPECT_TRUE(unit["preview"].is_null());
    const json failed = json::parse(
        run({"--cameras", "all", "--no-png", "--name", "{scene}/{camera}", "--failed", "--dry-run", "--json"}).out);
    EXPECT_EQ(failed["units"].size(), 1u);
    EXPECT_EQ(failed["units"][0]["reason"], "failed last time");
    EXPECT_NE(run({"--failed", "--only", "a"}).err.find("no image in out failed last time"), std::string::npos);
    EXPECT_EQ(json::parse(run({"--failed", "--only", "a", "--json"}).out)["units"].size(), 0u);
    EXPECT_EQ(json::parse(run({"--failed", "--only", "a", "--json", "--dry-run"}).out)["units"].size(), 0u);
    const Names named{"--cameras", "all", "--no-png", "--name", "{scene}/{camera}", "--failed", "--only", "a"};
    EXPECT_NE(run(named).err.find("no image that --only chooses failed last time; 1 that it leaves out did"),
              std::string::npos);
    // What is left out stays in the report.
    EXPECT_EQ(run({"--cameras", "all", "--no-png", "--name", "{scene}/{camera}", "--only", "a"}).exit_code, 0);
    json report = json::parse(read_file(work_ / "out/report.json"));
    ASSERT_EQ(report["units"].size(), 2u);
    EXPECT_EQ(report["units"][1]["outcome"], "failed");
    EXPECT_EQ(report["units"][1]["chosen"], false);
    EXPECT_NE(report["units"][1]["error"].get<std::string>().find("spq"), std::string::npos);
    EXPECT_EQ(run({"--cameras", "all", "--no-png", "--name", "{scene}/{camera}", "--only", "b"}).exit_code, 1);
    report = json::parse(read_file(work_ / "out/report.json"));
    EXPECT_EQ(report["units"][1]["outcome"], "up to date");
    EXPECT_EQ(report["units"][1]["spp"], 2);
}

TEST_F(Batch, DenoisesWhatIsNotDenoisedYet) {
    add_scene("a");
    EXPECT_EQ(run({"--denoise"}).exit_code, 0);
    EXPECT_TRUE(fs::exists(work_ / "out/a.denoised.exr"));
    const json unit = json::parse(read_file(work_ / "out/report.json"))["units"][0];
    EXPECT_EQ(unit["preview"], "a.denoised.png");
    EXPECT_GT(unit["seconds"]["denoise"], 0.0);
    EXPECT_EQ(events("unit finished").front()["pixels"], 16 * 12);
    EXPECT_GT(events("unit finished").front()["denoise_seconds"], 0.0);
    EXPECT_NE(run({"--denoise"}).err.find("1 image, all up to date"), std::string::npos);
    EXPECT_GT(json::parse(read_file(work_ / "out/report.json"))["units"][0]["seconds"]["denoise"], 0.0);
    fs::remove(work_ / "out/a.denoised.exr");
    const auto time = fs::last_write_time(work_ / "out/a.exr");
    EXPECT_NE(run({"--denoise"}).err.find("1 was not denoised"), std::string::npos);
    EXPECT_EQ(fs::last_write_time(work_ / "out/a.exr"), time) << "it was not rendered again";
    EXPECT_TRUE(fs::exists(work_ / "out/a.denoised.png"));
    const ProgramResult never = run({"--denoise", "--spp", "1", "--dry-run"});
    EXPECT_EQ(never.exit_code, 2) << never.out;
    EXPECT_NE(never.out.find("will fail"), std::string::npos) << never.out;
}

TEST_F(Batch, ShowsWhatIsDenoisedAsTheImage) {
    add_scene("a");
    EXPECT_EQ(run({"--denoise", "--view", "Un-tone-mapped", "--exposure", "-1.5", "--integrator", "path"}).exit_code,
              0);
    const auto shown = [&](Names how) {
        how.insert(how.begin(), {"view", "out/a.denoised.exr", "-o", "shown.png", "--quiet"});
        EXPECT_EQ(run_etendue(how, work_).exit_code, 0);
        return read_file(work_ / "shown.png");
    };
    EXPECT_EQ(read_file(work_ / "out/a.denoised.png"), shown({"--view", "Un-tone-mapped", "--exposure", "-1.5"}));
    EXPECT_NE(read_file(work_ / "out/a.denoised.png"), shown({}));
}

/// A directory stands where the image without noise is to be written.
TEST_F(Batch, RendersNothingAgainAsDenoisingFailed) {
    add_scene("a");
    EXPECT_EQ(run().exit_code, 0);
    fs::create_directories(work_ / "out/a.denoised.exr/in the way");
    const ProgramResult result = run({"--denoise", "--force"});
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_EQ(count("unit failed")["a"], 2) << result.err;
    const std::size_t first = result.err.find("auto chose");
    ASSERT_NE(first, std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("auto chose", first + 1), std::string::npos) << result.err;
}

TEST_F(Batch, SaysANoteOfAManyFramedSceneOnce) {
    add_scene("a");
    (void)animated_scene((folder_ / "scenes/a").string());
    name_missing_texture(folder_ / "scenes/a");
    const std::string err = run({"--frames", "1:3"}).err;
    const std::size_t first = err.find("missing.hdr");
    ASSERT_NE(first, std::string::npos) << err;
    EXPECT_EQ(err.find("missing.hdr", err.find('\n', first)), std::string::npos) << err;
}

TEST_F(Batch, VariantsAreImagesOfTheirOwn) {
    add_scene("shoe");
    const fs::path file = folder_ / "scenes/shoe/scene.gltf";
    std::string text = read_file(file);
    text.insert(text.find("\"scene\": 0,"),
                R"("extensionsUsed": ["KHR_materials_variants"],
                   "extensions": {"KHR_materials_variants": {"variants": [{"name": "red"}, {"name": "sky blue"}]}},
                   "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1]}},
                                 {"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 1, 1]}}],)");
    const std::string primitive = R"({"attributes": {"POSITION": 0}})";
    text.replace(text.find(primitive), primitive.size(),
                 R"({"attributes": {"POSITION": 0}, "material": 0, "extensions": {"KHR_materials_variants":
                     {"mappings": [{"variants": [0], "material": 0}, {"variants": [1], "material": 1}]}}})");
    write_file(file, text);
    const ProgramResult result = run({"--variants"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(fs::exists(work_ / "out/shoe.red.exr")) << result.err << result.out;
    EXPECT_NE(read_file(work_ / "out/shoe.red.png"), read_file(work_ / "out/shoe.sky blue.png"));
    EXPECT_NE(run({"--variants"}).err.find("2 images, all up to date"), std::string::npos);
    EXPECT_EQ(run({"--variants", "--variant", "red"}).exit_code, 2);
}

TEST_F(Batch, SeveralAtOnceRenderEverythingOnce) {
    for (const int processes : {2, 4}) {
        fs::remove_all(work_ / "out");
        constexpr int kScenes = 4;
        for (int i = 0; i < kScenes; ++i) add_scene(fmt::format("scene{}", i));
        std::vector<std::unique_ptr<RunningProgram>> batches;
        batches.reserve(static_cast<std::size_t>(processes));
        for (int i = 0; i < processes; ++i) batches.push_back(start({"--threads", "1"}));
        for (const auto& batch : batches) {
            const ProgramResult result = batch->wait();
            EXPECT_EQ(result.exit_code, 0) << result.err;
        }
        EXPECT_EQ(count("unit finished").size(), static_cast<std::size_t>(kScenes));
        for (const auto& [unit, times] : count("unit finished")) EXPECT_EQ(times, 1) << unit;
        for (const auto& [unit, times] : count("unit started")) EXPECT_EQ(times, 1) << unit;
        EXPECT_EQ(events("batch finished").size(), static_cast<std::size_t>(processes));
        expect_tidy();
    }
}

TEST_F(Batch, EvenByForceSeveralAtOnceRenderEverythingOnce) {
    for (const char* name : {"a", "b", "c"}) add_slow_scene(name, 0.3);
    EXPECT_EQ(run().exit_code, 0);
    fs::remove(work_ / "out/ledger.jsonl");
    const auto first = start({"--force"});
    // Nothing is finished before both have planned: what is there then was made before either began.
    const int child = child_of(*first);
    kill(child, SIGSTOP);
    const auto second = start({"--force"});
    ASSERT_TRUE(wait_until([&] { return events("batch started").size() == 2; }));
    kill(child, SIGCONT);
    expect_end(*first, 0);
    expect_end(*second, 0);
    for (const auto& [unit, times] : count("unit finished")) EXPECT_EQ(times, 1) << unit;
    EXPECT_EQ(count("unit finished").size(), 3u);
}

TEST_F(Batch, WaitsForWhatAnotherMakesAndThenEverythingIsThere) {
    add_slow_scene("slow", 2.0);
    const auto first = start();
    (void)child_of(*first);
    const ProgramResult dry = run({"--dry-run"});
    EXPECT_NE(dry.out.find("running elsewhere: "), std::string::npos) << dry.out;
    const ProgramResult second = run();
    EXPECT_EQ(second.exit_code, 0) << second.err;
    EXPECT_TRUE(fs::exists(work_ / "out/slow.json"));
    EXPECT_NE(second.err.find("waiting for"), std::string::npos) << second.err;
    EXPECT_NE(second.err.find("made by another batch process"), std::string::npos) << second.err;
    expect_end(*first, 0);
    EXPECT_EQ(count("unit finished"), (std::map<std::string, int>{{"slow", 1}}));
}

TEST_F(Batch, AnotherTakesOverWhatAKilledOneWasMaking) {
    add_scene("a");
    add_slow_scene("b", 1.5);
    add_scene("c");
    const auto killed = start();
    ASSERT_TRUE(wait_until([&] { return count("unit started")["b"] == 1; }));
    const int child = child_of(*killed);
    const auto other = start();
    killed->send(SIGKILL);
    expect_end(*killed, 1000 + SIGKILL);
    EXPECT_TRUE(wait_until([child] { return !fs::exists(fmt::format("/proc/{}", child)); })) << "nobody goes on";
    const ProgramResult result = other->wait();
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(count("unit finished"), (std::map<std::string, int>{{"a", 1}, {"b", 1}, {"c", 1}}));
    const json taken = events("unit started").back()["unit"] == "c" ? *(events("unit started").rbegin() + 1)
                                                                    : events("unit started").back();
    EXPECT_EQ(taken["unit"], "b");
    EXPECT_TRUE(taken.contains("taken_over_from")) << taken;
    expect_tidy();
}

TEST_F(Batch, ACrashIsRecordedAndTriedAgain) {
    add_slow_scene("a", 1.5);
    add_scene("b");
    const auto batch = start();
    kill(child_of(*batch), SIGSEGV);
    const ProgramResult result = batch->wait();
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("SIGSEGV"), std::string::npos) << result.err;
    ASSERT_EQ(events("unit failed").size(), 1u);
    const json failed = events("unit failed").front();
    EXPECT_EQ(failed["signal"], "SIGSEGV");
    EXPECT_EQ(failed["again"], true);
    EXPECT_FALSE(failed.contains("exit_code"));
    EXPECT_EQ(count("unit started"), (std::map<std::string, int>{{"a", 2}, {"b", 1}}));
    EXPECT_EQ(count("unit finished"), (std::map<std::string, int>{{"a", 1}, {"b", 1}}));
}

TEST_F(Batch, WhatDoesNotGoOnIsEndedAndTriedAgain) {
    add_slow_scene("a", 1.5);
    const auto batch = start({"--stall-minutes", "0.05"});
    kill(child_of(*batch), SIGSTOP);
    const ProgramResult result = batch->wait();
    EXPECT_EQ(result.exit_code, 0) << result.err;
    ASSERT_EQ(events("unit failed").size(), 1u);
    EXPECT_NE(events("unit failed").front()["error"].get<std::string>().find("no progress"), std::string::npos);
    EXPECT_EQ(count("unit started"), (std::map<std::string, int>{{"a", 2}}));
}

TEST_F(Batch, ACrashThatIsNotTriedAgainFailsItsImageOnly) {
    add_slow_scene("a", 60.0);
    add_scene("b");
    const auto batch = start({"--retries", "0"});
    kill(child_of(*batch), SIGSEGV);
    const ProgramResult result = batch->wait();
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_TRUE(fs::exists(work_ / "out/b.exr"));
    const json report = json::parse(read_file(work_ / "out/report.json"));
    EXPECT_EQ(report["units"][0]["outcome"], "failed");
    EXPECT_EQ(report["units"][0]["signal"], "SIGSEGV");
    EXPECT_NE(result.out.find("ended by SIGSEGV"), std::string::npos) << result.out;
    // The next batch knows.
    EXPECT_EQ(json::parse(run({"--dry-run", "--json"}).out)["units"][0]["reason"], "failed last time");
}

TEST_F(Batch, AnInvalidSceneIsTriedOnceAndTheOthersAreRendered) {
    add_scene("a");
    add_scene("b", R"("camera_": 3,)");
    const ProgramResult result = run({"--retries", "5"});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(count("unit started"), (std::map<std::string, int>{{"a", 1}, {"b", 1}}));
    EXPECT_EQ(events("unit failed").front()["exit_code"], 3);
    EXPECT_NE(events("unit failed").front()["error"].get<std::string>().find("camera_"), std::string::npos);
    EXPECT_NE(result.out.find("camera_"), std::string::npos) << result.out;
}

TEST_F(Batch, TheOtherImagesOfAnInvalidSceneAreSaidNotToBeTried) {
    add_scene("a", R"("camera_": 3,)");
    const ProgramResult result = run({"--frames", "1:3"});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.out.find("\n2 images were not tried, as their scene failed\n1 failed in "), std::string::npos)
        << result.out;
    EXPECT_EQ(count("unit failed"), (std::map<std::string, int>{{"a.0001", 1}}));
    EXPECT_EQ(count("unit not tried"), (std::map<std::string, int>{{"a.0002", 1}, {"a.0003", 1}}));
    const json end = events("batch finished").front();
    EXPECT_EQ(end["units"], 3);
    EXPECT_EQ(end["failed"], 1);
    EXPECT_EQ(end["not_tried"], 2);
    const json plan = json::parse(run({"--frames", "1:3", "--dry-run", "--json"}).out);
    EXPECT_EQ(plan["units"][1]["reason"], "was not tried last time, as its scene was invalid");
}

TEST_F(Batch, InputThatVanishesOrCannotBeDecodedFailsItsImageOnly) {
    add_slow_scene("a-slow", 1.5);
    add_scene("b-undecodable");
    write_file(folder_ / "scenes/b-undecodable/sky.exr", "this is no image");
    write_file(folder_ / "scenes/b-undecodable/render.json", R"({"spp": 1, "environment": {"image": "sky.exr"}})");
    add_scene("c-vanishes");
    add_scene("d-good");
    const auto batch = start();
    // The plan is made, and the first image is under way.
    ASSERT_TRUE(wait_until([&] { return !events("unit started").empty(); }));
    fs::remove(folder_ / "scenes/c-vanishes/triangle.bin");
    expect_end(*batch, 1);
    std::map<std::string, std::string> errors;
    for (const json& event : events("unit failed")) errors[event["unit"]] = event["error"];
    EXPECT_EQ(errors.size(), 2u);
    EXPECT_NE(errors["b-undecodable"].find("sky.exr"), std::string::npos) << errors["b-undecodable"];
    EXPECT_NE(errors["c-vanishes"].find("triangle.bin"), std::string::npos) << errors["c-vanishes"];
    for (const char* name : {"a-slow", "d-good"}) EXPECT_TRUE(fs::exists(work_ / "out" / (std::string(name) + ".exr")));
    for (const char* name : {"b-undecodable", "c-vanishes"})
        for (const char* extension : {".exr", ".png", ".json"})
            EXPECT_FALSE(fs::exists(work_ / "out" / (std::string(name) + extension))) << name << extension;
}

TEST_F(Batch, TheMemoryLimitFailsTheSceneThatNeedsMore) {
    if (kHasSanitizers) GTEST_SKIP() << "AddressSanitizer maps more memory than any limit allows";
    add_scene("large", R"("unused": 0,)");
    write_file(folder_ / "scenes/large/render.json", R"({"size": [8192, 8192], "spp": 1, "environment": {}})");
    add_scene("small");
    const ProgramResult result = run({"--max-memory", "1G", "--threads", "1"});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_TRUE(fs::exists(work_ / "out/small.exr")) << result.err;
    EXPECT_NE(result.out.find("more memory than --max-memory 1G"), std::string::npos) << result.out;
    EXPECT_EQ(count("unit started"), (std::map<std::string, int>{{"large", 1}, {"small", 1}})) << "it is no use";
    EXPECT_EQ(run({"--max-memory", "1G", "--in-process"}).exit_code, 2);
    EXPECT_EQ(run({"--max-memory", "1"}).exit_code, 2);
    EXPECT_EQ(run({"--max-memory", "255M"}).exit_code, 2) << "the program alone may need more";
}

TEST_F(Batch, AnInterruptIsPassedOnAndTheNextBatchGoesOnToTheSameImage) {
    const std::string settings = R"({"size": [64, 48], "spp": 1000, "environment": {}})";
    add_scene("a");
    add_scene("b");
    write_file(folder_ / "scenes/a/render.json", settings);
    for (const auto& [signal, code] : {std::pair{SIGINT, 130}, std::pair{SIGTERM, 143}, std::pair{SIGHUP, 143}}) {
        fs::remove_all(work_ / "out");
        const auto batch = start({"--threads", "1", "--checkpoint-every", "0.001", "--on-finish",
                                  "echo $ETENDUE_INTERRUPTED $ETENDUE_NOT_STARTED > finished"});
        // A signal that comes before there are samples leaves nothing to go on with.
        ASSERT_TRUE(wait_until([&] { return fs::exists(work_ / "out/a.checkpoint"); }));
        batch->send(signal);
        const ProgramResult result = batch->wait();
        EXPECT_EQ(result.exit_code, code) << result.err;
        EXPECT_EQ(count("unit interrupted"), (std::map<std::string, int>{{"a", 1}})) << result.err;
        EXPECT_EQ(count("unit started").size(), 1u) << "nothing else is begun";
        EXPECT_FALSE(fs::exists(work_ / "out/.etendue"));
        EXPECT_EQ(json::parse(read_file(work_ / "out/report.json"))["interrupted"], true);
        EXPECT_EQ(json::parse(read_file(work_ / "out/report.json"))["units"][0]["camera"], "main");
        EXPECT_EQ(events("batch finished").front()["interrupted"], 1);
        EXPECT_EQ(read_file(work_ / "finished"), "1 1\n");
    }
    EXPECT_TRUE(fs::exists(work_ / "out/a.checkpoint"));
    const ProgramResult next = run();
    EXPECT_EQ(next.exit_code, 0) << next.err;
    EXPECT_NE(next.err.find("goes on from a checkpoint"), std::string::npos) << next.err;
    const json report = json::parse(read_file(work_ / "out/report.json"));
    EXPECT_GT(report["units"][0]["seconds_before"], 0.0);
    EXPECT_LT(report["totals"]["rays"], report["units"][0]["rays"].get<int>() + report["units"][1]["rays"].get<int>());
    expect_tidy();
    const std::string image = read_file(work_ / "out/a.png");
    EXPECT_EQ(run({"--force", "--quiet"}).exit_code, 0);
    EXPECT_EQ(read_file(work_ / "out/a.png"), image);
}

/// Ctrl-Z in a terminal reaches the batch alone.
TEST_F(Batch, WhatRendersForItStopsAndGoesOnWithIt) {
    add_scene("a");
    write_file(folder_ / "scenes/a/render.json", R"({"size": [64, 48], "spp": 10000000, "environment": {}})");
    const auto batch = start();
    const int child = child_of(*batch);
    const auto is_stopped = [](int process) {
        const std::string stat = read_file(fmt::format("/proc/{}/stat", process));
        return stat.at(stat.rfind(')') + 2) == 'T';
    };
    batch->send(SIGTSTP);
    EXPECT_TRUE(wait_until([&] { return is_stopped(child) && is_stopped(batch->pid()); }));
    batch->send(SIGCONT);
    EXPECT_TRUE(wait_until([&] { return !is_stopped(child) && !is_stopped(batch->pid()); }));
    batch->send(SIGINT);
    expect_end(*batch, 130);
}

/// As those that end a job or a container send it. The child gets it twice, once through the batch.
TEST_F(Batch, ASignalToAllProcessesStillWritesWhatThereIs) {
    add_scene("a");
    // Large enough for the image to be written for a while.
    write_file(folder_ / "scenes/a/render.json", R"({"size": [640, 480], "spp": 10000000, "environment": {}})");
    const auto batch = start({"--checkpoint-every", "0.01"});
    const int child = child_of(*batch);
    ASSERT_TRUE(wait_until([&] { return fs::exists(work_ / "out/a.checkpoint"); }));
    kill(child, SIGTERM);
    usleep(10000);  // or both signals are one
    batch->send(SIGTERM);
    const ProgramResult result = batch->wait();
    EXPECT_EQ(result.exit_code, 143) << result.err;
    EXPECT_EQ(count("unit interrupted")["a"], 1);
    EXPECT_TRUE(fs::exists(work_ / "out/a.json")) << "it was ended at once";
}

TEST_F(Batch, ASecondInterruptEndsEverythingAtOnce) {
    add_slow_scene("a", 1000.0);
    const auto batch = start();
    const int child = child_of(*batch);
    kill(child, SIGSTOP);
    batch->send(SIGINT);
    EXPECT_TRUE(wait_until([&] { return !handles_interrupt(batch->pid()); }));
    EXPECT_FALSE(batch->has_ended()) << "it waits for the image";
    batch->send(SIGINT);
    expect_end(*batch, 1000 + SIGINT);
    EXPECT_TRUE(wait_until([child] { return !fs::exists(fmt::format("/proc/{}", child)); }));
}

/// Batches that render several images at the same time.
class BatchJobs : public Batch {
  protected:
    /// How much memory an image needs is known by the limit that it has, unless sanitizers ask for more.
    [[nodiscard]] Names with_jobs(const Names& more) const {
        if (kHasSanitizers) return with_probes(more);
        Names all = arguments(more);
        all.insert(all.end(), {"--max-memory", "512M"});
        return all;
    }
    [[nodiscard]] Names with_probes(const Names& more) const {
        Names all = arguments(more);
        std::erase(all, "--no-probe");
        return all;
    }
    [[nodiscard]] json report() const {
        return json::parse(fs::exists(work_ / "out/report.json") ? read_file(work_ / "out/report.json") : "{}", nullptr,
                           false);
    }
};

TEST_F(BatchJobs, MakeTheSameImagesAndReport) {
    for (const char* name : {"a", "b/c"}) add_scene(name);
    add_scene("e", R"("camera_": 3,)");
    const auto result_of = [&](const Names& more) {
        const ProgramResult result = run_etendue(with_jobs(more), work_);
        EXPECT_EQ(result.exit_code, 1) << result.err;
        json report = json::parse(read_file(work_ / "out/report.json"));
        std::map<std::string, std::string> images;
        for (const json& unit : report["units"])
            if (unit["outcome"] == "rendered") images[unit["name"]] = read_file(work_ / "out" / unit["preview"]);
        for (json& unit : report["units"])
            for (const char* key : {"seconds", "estimated_seconds", "rays_per_second", "peak_memory_bytes"})
                unit.erase(key);
        fs::rename(work_ / "out/a.exr", work_ / (more.empty() ? "one.exr" : "three.exr"));
        fs::remove_all(work_ / "out");
        report["totals"].erase("seconds");
        report["totals"].erase("peak_memory_bytes");
        return std::pair(images, json{report["units"], report["totals"]});
    };
    const auto one = result_of({});
    EXPECT_EQ(one.first.size(), 2u);
    EXPECT_EQ(result_of({"--jobs", "3", "--threads", "3"}), one);
    const ProgramResult difference = run_etendue({"diff", "one.exr", "three.exr", "--json"}, work_);
    EXPECT_EQ(json::parse(difference.out)["measures"]["mse"]["value"], 0.0) << difference.out;
}

TEST_F(BatchJobs, TheFirstFrameIsMadeBeforeTheOthersWhichTakeItsExposure) {
    add_scene("a");
    (void)animated_scene((folder_ / "scenes/a").string());
    const Names jobs{"--jobs", "3", "--threads", "3", "--frames", "1:4", "--order", "newest"};
    const ProgramResult result = run_etendue(with_jobs(jobs), work_);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err.find("flicker"), std::string::npos) << result.err;
    std::istringstream ledger(read_file(work_ / "out/ledger.jsonl"));
    std::string first;
    for (std::string line; std::getline(ledger, line);) {
        const json event = json::parse(line);
        if (event["event"] != "unit started" && event["event"] != "unit finished") continue;
        if (first.empty()) first = event["unit"];
        EXPECT_EQ(event["unit"], first) << line;
        if (event["event"] == "unit finished") break;
    }
    EXPECT_EQ(first, "a.0001");
    const json chosen = json::parse(read_file(work_ / "out/a.0001.json"))["exposure"];
    EXPECT_NE(chosen["chosen"], "that of the first frame") << chosen;
    for (const int frame : {2, 3, 4}) {
        const json taken = json::parse(read_file(work_ / fmt::format("out/a.{:04}.json", frame)))["exposure"];
        EXPECT_EQ(taken["chosen"], "that of the first frame") << taken;
        EXPECT_EQ(taken["stops"], chosen["stops"]);
    }
}

/// Nothing waits for ever.
TEST_F(BatchJobs, TheOtherFramesAreMadeIfTheFirstFails) {
    add_scene("a");
    (void)animated_scene((folder_ / "scenes/a").string());
    fs::create_directories(work_ / "out/a.0001.exr");  // where no image can be written
    const Names jobs{"--jobs", "2", "--retries", "0", "--frames", "1:3"};
    const ProgramResult result = run_etendue(with_jobs(jobs), work_);
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_EQ(count("unit failed"), (std::map<std::string, int>{{"a.0001", 1}})) << result.err;
    EXPECT_EQ(count("unit finished"), (std::map<std::string, int>{{"a.0002", 1}, {"a.0003", 1}})) << result.err;
}

TEST_F(BatchJobs, AreInterruptedTogetherAndKeepTheirCheckpoints) {
    for (const char* name : {"a", "b", "c"}) add_slow_scene(name, 1000.0);
    RunningProgram batch(with_jobs({"--jobs", "2", "--threads", "2", "--checkpoint-every", "0.001"}), work_);
    ASSERT_TRUE(wait_until([&] {
        const json now = report();
        return batch.has_ended() || (now.contains("totals") && now["totals"]["running"] == 2 &&
                                     fs::exists(work_ / "out/a.checkpoint") && fs::exists(work_ / "out/b.checkpoint"));
    }));
    batch.send(SIGINT);
    const ProgramResult result = batch.wait();
    EXPECT_EQ(result.exit_code, 130) << result.err;
    EXPECT_EQ(count("unit interrupted"), (std::map<std::string, int>{{"a", 1}, {"b", 1}})) << result.err;
    EXPECT_EQ(count("unit started").size(), 2u) << "nothing else is begun";
    EXPECT_FALSE(fs::exists(work_ / "out/.etendue"));
    EXPECT_EQ(report()["totals"]["interrupted"], 2);
    EXPECT_EQ(json::parse(read_file(work_ / "out/a.json"))["threads"], 1) << "its share";
    const json plan = json::parse(run({"--dry-run", "--json"}).out);
    for (const std::size_t unit : {0u, 1u})
        EXPECT_NE(plan["units"][unit]["reason"].get<std::string>().find("goes on from a checkpoint"), std::string::npos)
            << plan;
}

TEST_F(BatchJobs, ACrashFailsItsImageOnly) {
    add_slow_scene("a", 60.0);
    add_scene("b");
    add_scene("c");
    RunningProgram batch(with_jobs({"--jobs", "2", "--retries", "0"}), work_);
    int child = 0;
    ASSERT_TRUE(wait_until([&] {
        for (const int each : children_of(batch.pid())) {
            const std::string command = command_of(each);
            if (command.find("scenes/a") != std::string::npos && command.find("--probe") == std::string::npos &&
                command.starts_with(std::string("etendue\0render", 14)) && handles_interrupt(each))
                child = each;
        }
        return child != 0 || batch.has_ended();
    }));
    ASSERT_NE(child, 0);
    kill(child, SIGSEGV);
    const ProgramResult result = batch.wait();
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_EQ(count("unit finished"), (std::map<std::string, int>{{"b", 1}, {"c", 1}}));
    EXPECT_EQ(events("unit failed").front()["signal"], "SIGSEGV");
    EXPECT_EQ(report()["units"][0]["outcome"], "failed");
    expect_tidy();
}

TEST_F(BatchJobs, WaitForMemoryAndSaySoOnce) {
    for (const char* name : {"a", "b"}) add_scene(name);
    const Names budget{"--jobs", "2", "--jobs-memory", "256M", "--no-png"};
    const ProgramResult result = run_etendue(with_probes(budget), work_);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const std::size_t first = result.err.find("waits for memory");
    ASSERT_NE(first, std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("waits for memory", first + 1), std::string::npos) << result.err;
    std::istringstream ledger(read_file(work_ / "out/ledger.jsonl"));
    int under_way = 0;
    for (std::string line; std::getline(ledger, line);) {
        const std::string event = json::parse(line)["event"];
        under_way += event == "unit started" ? 1 : event == "unit finished" ? -1 : 0;
        EXPECT_LE(under_way, 1) << line;
    }
    EXPECT_EQ(count("unit finished").size(), 2u);
}

TEST_F(BatchJobs, WithoutSenseAreUsageErrors) {
    add_scene("a");
    for (const Names& wrong :
         {Names{"--jobs", "0"}, Names{"--jobs", "2x"}, Names{"--jobs", "2"}, Names{"--jobs", "2", "--in-process"},
          Names{"--jobs-memory", "1G"}, Names{"--jobs", "auto", "--jobs-memory", "1"}}) {
        const ProgramResult result = run(wrong);
        EXPECT_EQ(result.exit_code, 2) << result.err;
        EXPECT_NE(result.err.find("--jobs"), std::string::npos) << result.err;
        EXPECT_TRUE(list(work_).empty());
    }
}

/// Batches that render in processes of their own, and in this.
class BatchEitherWay : public Batch, public testing::WithParamInterface<bool> {
  protected:
    [[nodiscard]] Names with(Names more) const {
        if (GetParam()) more.emplace_back("--in-process");
        return more;
    }
};
INSTANTIATE_TEST_SUITE_P(Processes, BatchEitherWay, testing::Bool(),
                         [](const auto& test) { return test.param ? "InProcess" : "InChildren"; });

TEST_P(BatchEitherWay, ACheckpointOfOtherSettingsIsNoObstacle) {
    add_slow_scene("a", 60.0);
    const auto batch = start({"--checkpoint-every", "0.001"});
    ASSERT_TRUE(wait_until([&] { return fs::exists(work_ / "out/a.checkpoint"); }));
    batch->send(SIGKILL);
    (void)batch->wait();
    EXPECT_EQ(json::parse(run({"--dry-run", "--json"}).out)["units"][0]["reason"],
              "was interrupted, goes on from a checkpoint");
    const ProgramResult result = run(with({"--seed", "99", "--spp", "4", "--retries", "0"}));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("begins anew without the checkpoint"), std::string::npos) << result.err;
    EXPECT_EQ(json::parse(read_file(work_ / "out/a.json"))["spp"]["done"], 4);
    expect_tidy();
}

/// And the other images of its scene are none of its business.
TEST_P(BatchEitherWay, ADamagedCheckpointIsNoObstacle) {
    add_scene("a");
    (void)animated_scene((folder_ / "scenes/a").string());
    fs::create_directories(work_ / "out");
    for (const char* frame : {"1", "2"})
        write_file(work_ / fmt::format("out/a.000{}.checkpoint", frame), "this is none, but long enough for a hash");
    const ProgramResult result = run(with({"--frames", "1:2", "--retries", "0"}));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("no other checkpoint is left"), std::string::npos) << result.err;
    EXPECT_TRUE(fs::exists(work_ / "out/a.0002.exr"));
    expect_tidy();
}

/// As on a disk that was full for a moment: a directory stands where the image is to be written.
TEST_F(Batch, AFailureBeforeTheFirstSampleKeepsTheCheckpoint) {
    add_scene("a");
    const fs::path settings = folder_ / "scenes/a/render.json";
    write_file(settings, R"({"size": [16, 12], "spp": 10000000, "environment": {}})");
    const auto batch = start({"--checkpoint-every", "0.001"});
    ASSERT_TRUE(wait_until([&] { return fs::exists(work_ / "out/a.checkpoint"); }));
    batch->send(SIGKILL);
    (void)batch->wait();
    fs::remove(work_ / "out/a.exr");
    fs::create_directories(work_ / "out/a.exr/in the way");
    const ProgramResult failed = run({"--retries", "1"});
    EXPECT_EQ(failed.exit_code, 1) << failed.err;
    EXPECT_EQ(failed.err.find("without the checkpoint"), std::string::npos) << failed.err;
    EXPECT_EQ(count("unit failed")["a"], 2);
}

TEST_F(Batch, ACheckpointBesideAFinishedImageIsRemoved) {
    add_scene("a");
    EXPECT_EQ(run().exit_code, 0);
    write_file(work_ / "out/a.checkpoint", "of a render that was killed when its image was complete");
    EXPECT_EQ(run({"--dry-run"}).exit_code, 0);
    EXPECT_TRUE(fs::exists(work_ / "out/a.checkpoint"));
    EXPECT_EQ(run().exit_code, 0);
    EXPECT_EQ(count("unit started")["a"], 1);
    expect_tidy();
}

// Somebody starts another batch on the same directory, with a mistyped option.
TEST_F(Batch, AMistakeOfAnotherFailsNothing) {
    add_slow_scene("a", 2.0);
    add_scene("b");
    const auto batch = start();
    (void)child_of(*batch);
    EXPECT_NE(run({"--camera", "nope"}).exit_code, 0);
    EXPECT_EQ(run_etendue({"batch", (folder_ / "scenes").string(), "-o", "out", "--camera", "nope"}, work_).exit_code,
              2);
    expect_end(*batch, 0);
    EXPECT_EQ(count("unit finished"), (std::map<std::string, int>{{"a", 1}, {"b", 1}}));
}

TEST_F(Batch, ReplacesNoInputsOfScenes) {
    add_scene("sky");
    add_scene("lit");
    write_file(folder_ / "scenes/lit/render.json", R"({"environment": {"image": "sky.exr"}})");
    fs::create_directories(work_ / "out");
    write_file(work_ / "out/sky.exr", "a map");
    for (const Names& more : {Names{"--assets", "out"}, Names{"--assets", "out", "--only", "sky"}}) {
        const ProgramResult result = run(more);
        EXPECT_EQ(result.exit_code, 2) << result.err;
        EXPECT_NE(result.err.find("it is an input"), std::string::npos) << result.err;
        EXPECT_EQ(read_file(work_ / "out/sky.exr"), "a map");
    }
    const std::string settings = folder_ / "scenes/lit/render.json";
    EXPECT_EQ(run({"--only", "sky", "--log", settings}).exit_code, 2) << "of a scene that is left out";
}

/// Made up: that another machine's batch says so while this one waits for its lock.
TEST_F(Batch, OneMachinesFailureIsAnothersOnlyIfTheSceneIsInvalid) {
    for (const auto& [code, rendered] : {std::pair{1, true}, std::pair{3, false}}) {
        fs::remove_all(work_ / "out");
        add_slow_scene("a", 1.0);
        add_scene("b");
        const auto batch = start();
        ASSERT_TRUE(wait_until([&] { return count("unit started")["a"] == 1 || batch->has_ended(); }));
        std::ofstream(work_ / "out/ledger.jsonl", std::ios::app) << fmt::format(
            "{{\"event\":\"unit failed\",\"host\":\"elsewhere\",\"unit\":\"b\",\"exit_code\":{}}}\n", code);
        expect_end(*batch, rendered ? 0 : 1);
        EXPECT_EQ(fs::exists(work_ / "out/b.exr"), rendered) << code;
    }
}

TEST_F(Batch, InProcessDoesTheSameWithoutOtherProcesses) {
    add_scene("a");
    add_scene("b", R"("camera_": 3,)");
    add_slow_scene("c", 1.0);
    const auto batch = start({"--in-process"});
    ASSERT_TRUE(wait_until([&] { return count("unit started")["c"] == 1 || batch->has_ended(); }));
    EXPECT_TRUE(children_of(batch->pid()).empty());
    const ProgramResult result = batch->wait();
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_EQ(count("unit finished"), (std::map<std::string, int>{{"a", 1}, {"c", 1}}));
    EXPECT_EQ(count("unit failed"), (std::map<std::string, int>{{"b", 1}}));
    EXPECT_NE(result.out.find("camera_"), std::string::npos) << result.out;
    expect_tidy();
}

TEST_F(Batch, ADirectoryThatCannotBeWrittenIsAnErrorBeforeAnythingStarts) {
    add_scene("a");
    write_file(work_ / "out", "a file");
    const ProgramResult file = run();
    EXPECT_EQ(file.exit_code, 2);
    EXPECT_NE(file.err.find("error: --output 'out' is a file"), std::string::npos) << file.err;
    EXPECT_EQ(list(work_), Names{"out"});
    // Nobody may write there, not even root.
    const ProgramResult system =
        run_etendue({"batch", (folder_ / "scenes").string(), "-o", "/proc/self", "--no-probe"}, work_);
    EXPECT_EQ(system.exit_code, 1);
    EXPECT_NE(system.err.find("error: cannot"), std::string::npos) << system.err;
    EXPECT_EQ(system.err.find("rendered"), std::string::npos) << system.err;
}

TEST_F(Batch, ALedgerThatIsNoFileIsAnErrorAtOnce) {
    add_scene("a");
    fs::create_directories(work_ / "out");
    const fs::path ledger = work_ / "out/ledger.jsonl";
    for (const std::string device : {"/dev/full", "/dev/zero", "a pipe"}) {
        fs::remove(ledger);
        if (device.starts_with('/'))
            fs::create_symlink(device, ledger);
        else
            ASSERT_EQ(::mkfifo(ledger.c_str(), 0600), 0);
        for (const Names& more : {Names{}, Names{"--failed"}, Names{"--dry-run"}, Names{"--in-process"}}) {
            const ProgramResult result = run(more);
            EXPECT_EQ(result.exit_code, 1) << device;
            EXPECT_NE(result.err.find("out/ledger.jsonl: it is no regular file"), std::string::npos) << result.err;
        }
    }
    EXPECT_EQ(list(work_ / "out"), Names{"ledger.jsonl"});
}

TEST_F(Batch, StatisticsThatAreAPipeFailTheirImageOnly) {
    add_scene("a");
    add_scene("b");
    ASSERT_EQ(run().exit_code, 0);
    fs::remove(work_ / "out/a.json");
    ASSERT_EQ(::mkfifo((work_ / "out/a.json").c_str(), 0600), 0);
    const ProgramResult result = run();
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.err.find("a.json: it is a pipe or a socket"), std::string::npos) << result.err;
    EXPECT_EQ(json::parse(read_file(work_ / "out/report.json"))["totals"]["up_to_date"], 1);
}

TEST_F(Batch, ATornLedgerIsGoneOnWith) {
    add_scene("a");
    fs::create_directories(work_ / "out");
    write_file(work_ / "out/ledger.jsonl", R"({"event":"unit failed","unit":"a"})"
                                           "\n"
                                           R"({"event":"unit fin)");
    EXPECT_NE(run().err.find("1 failed last time"), std::string::npos);
    const std::string text = read_file(work_ / "out/ledger.jsonl");
    EXPECT_NE(text.find("\"unit fin\n{\"event\":\"batch started\""), std::string::npos) << text;
}

}  // namespace

}  // namespace etendue::test
