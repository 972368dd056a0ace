#include "batch/batch_plan.h"

#include "batch/batch_child.h"
#include "batch/batch_statistics.h"
#include "program/small_files.h"
#include "session/input_files.h"
#include "session/prepared_scene.h"

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

namespace etendue::test {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class BatchPlanTest : public testing::Test {
  protected:
    BatchPlanTest() {
        write_scene(folder_ / "scene");
        unit_.task = {.job = {.scene = folder_ / "scene", .output = folder_ / "box.exr", .name = "box", .frame = {}},
                      .render_output = folder_ / "box.exr",
                      .id = "box"};
    }
    /// As if it had been rendered with the options.
    void render(bool complete = true) {
        auto prepared = prepare_scene(folder_ / "scene", options_.overrides);
        hash_inputs(prepared.scene, prepared.inputs);
        json inputs = json::array();
        for (const InputFile& file : prepared.inputs)
            inputs.push_back(
                {{"path", file.path}, {"size", file.size}, {"modified", file.modified}, {"content", file.content}});
        write_file(folder_ / "box.exr", "exr");
        write_file(folder_ / "box.png", "png");
        write_file(folder_ / "box.json",
                   json{{"complete", complete},
                        {"inputs", inputs},
                        {"spp", {{"done", 12}, {"requested", 48}}},
                        {"settings_hash", settings_hash(prepared.scene, options_.overrides.depth)}}
                       .dump());
    }
    static void age(const fs::path& file, int seconds) {
        fs::last_write_time(file, fs::file_time_type::clock::now() - std::chrono::seconds(seconds));
    }
    std::string reason(bool force = false) {
        LedgerHistory history(folder_ / "ledger.jsonl");
        history.read_new();
        examine(unit_, options_, force, history);
        return unit_.reason;
    }

    TestFolder folder_;
    BatchOptions options_{};
    PlannedUnit unit_{};
};

TEST_F(BatchPlanTest, SaysWhyAnImageIsStale) {
    EXPECT_EQ(reason(), "never rendered");
    render();
    EXPECT_EQ(reason(), "");
    EXPECT_EQ(reason(true), kForced);
    age(folder_ / "scene/triangle.bin", -10);
    EXPECT_EQ(reason(), "") << "another time is not another content";
    write_file(folder_ / "scene/triangle.bin", read_file(folder_ / "scene/triangle.bin") + "more");
    EXPECT_EQ(reason(), "input triangle.bin has changed");
    render();
    options_.overrides.give("--spp", "7");
    EXPECT_EQ(reason(), "settings changed");
    render();
    EXPECT_EQ(reason(), "");
    fs::remove(folder_ / "box.png");
    EXPECT_EQ(reason(), "box.png is missing");
    render();
    write_file(folder_ / "scene/scene.gltf", "broken");
    EXPECT_EQ(reason(), "input scene.gltf has changed") << "it is not loaded here";
}

TEST_F(BatchPlanTest, SaysWhatCanBeGoneOnWith) {
    render(false);
    EXPECT_EQ(reason(), "was interrupted at 12 of 48 spp");
    EXPECT_EQ(unit_.done, 0.0) << "nothing was kept of it";
    write_file(folder_ / "box.checkpoint", "");
    EXPECT_EQ(reason(), "was interrupted at 12 of 48 spp, goes on from a checkpoint");
    EXPECT_EQ(unit_.done, 0.25);
    json statistics = json::parse(read_file(folder_ / "box.json"));
    statistics["requested_settings"] =
        json::parse(requested_settings(prepare_scene(folder_ / "scene", options_.overrides).scene.settings));
    write_file(folder_ / "box.json", statistics.dump());
    options_.overrides.give("--seed", "7");
    EXPECT_EQ(reason(), "was interrupted at 12 of 48 spp, begins anew as its settings changed: seed: 0 -> 7");
    EXPECT_FALSE(unit_.resumes);
    EXPECT_EQ(unit_.done, 0.0);
    age(folder_ / "box.json", 10);
    EXPECT_EQ(reason(), "was interrupted at 12 of 48 spp, goes on from a checkpoint") << "of a later render";
    EXPECT_TRUE(unit_.resumes);
    fs::remove(folder_ / "box.exr");
    fs::remove(folder_ / "box.png");
    fs::remove(folder_ / "box.json");
    EXPECT_EQ(reason(), "was interrupted, goes on from a checkpoint");
    const BatchLedger ledger(folder_ / "ledger.jsonl");
    ledger.append({.kind = LedgerEventKind::UnitFailed, .unit = "box"});
    EXPECT_EQ(reason(), "failed last time, goes on from a checkpoint");
    fs::remove(folder_ / "box.checkpoint");
    EXPECT_EQ(reason(), "failed last time");
    ledger.append({.kind = LedgerEventKind::UnitFinished, .unit = "box"});
    EXPECT_EQ(reason(), "never rendered") << "somebody has removed the image";
}

TEST_F(BatchPlanTest, SaysWhatIsNotDenoised) {
    render();
    options_.denoise = true;
    const std::string png("...\0\0\0\0IEND\xae\x42\x60\x82", 15);
    EXPECT_EQ(reason(), "was not denoised");
    write_file(folder_ / "box.denoised.exr", "exr");
    EXPECT_EQ(reason(), "was not denoised") << "there is no PNG";
    write_file(folder_ / "box.denoised.png", png.substr(0, 14));
    EXPECT_EQ(reason(), "was not denoised") << "it is cut";
    write_file(folder_ / "box.denoised.png", png);
    EXPECT_EQ(reason(), "");
    options_.overrides.png = false;
    fs::remove(folder_ / "box.denoised.png");
    EXPECT_EQ(reason(), "");
}

TEST_F(BatchPlanTest, TellsTwoStatesOfAFileApart) {
    const fs::path file = folder_ / "file";
    EXPECT_EQ(FileStamp::of(file), FileStamp{});
    write_file(file, "a");
    const FileStamp first = FileStamp::of(file);
    EXPECT_EQ(FileStamp::of(file), first);
    age(file, 7);
    EXPECT_NE(FileStamp::of(file), first);
    EXPECT_NE(first, FileStamp{});
}

TEST_F(BatchPlanTest, SaysWhatMoreSamplesGoOnFrom) {
    options_.overrides.give("--spp", "12");
    render();
    json statistics = json::parse(read_file(folder_ / "box.json"));
    statistics["requested_settings"] =
        json::parse(requested_settings(prepare_scene(folder_ / "scene", options_.overrides).scene.settings));
    write_file(folder_ / "box.json", statistics.dump());
    options_.overrides.give("--spp", "48");
    EXPECT_EQ(reason(), "settings changed: spp: 12 -> 48");
    EXPECT_EQ(unit_.done, 0.0);
    write_file(folder_ / "box.sums", "");
    EXPECT_EQ(reason(), "settings changed: spp: 12 -> 48, goes on from its sums");
    EXPECT_EQ(unit_.done, 0.25);
    options_.overrides.give("--spp", "12");
    options_.overrides.give("--exposure", "2");
    options_.overrides.give("--owner", "me");
    EXPECT_EQ(reason(),
              "settings changed: color.exposure: null -> 2; metadata.owner: null -> \"me\", goes on from its sums");
    EXPECT_EQ(unit_.done, 1.0) << "only its files are written";
    options_.overrides.give("--seed", "2");
    EXPECT_EQ(reason().find("sums"), std::string::npos) << "it is another image";
}

TEST_F(BatchPlanTest, IsSummedUp) {
    BatchPlan plan(4, unit_);
    EXPECT_EQ(summary(plan), "4 images, all up to date");
    plan[0].reason = "never rendered";
    plan[1].reason = "settings changed";
    plan[2].reason = "never rendered";
    EXPECT_EQ(summary(plan), "3 of 4 images to render: 2 never rendered; 1 settings changed");
    for (int i = 0; i < 3; ++i) plan[static_cast<std::size_t>(i)].estimated_seconds = 40.0;
    EXPECT_EQ(summary(plan), "3 of 4 images to render, about 2:00: 2 never rendered; 1 settings changed");
    EXPECT_EQ(totals(plan).seconds, 120.0);
    const json all = json::parse(to_json(plan));
    EXPECT_EQ(all["stale"], 3);
    EXPECT_EQ(all["estimated_seconds"], 120.0);
    EXPECT_EQ(all["units"][1]["reason"], "settings changed");
    EXPECT_EQ(all["units"][3]["stale"], false);
    EXPECT_NE(to_table(plan).find("3 of 4 images to render, about 2:00\n"), std::string::npos) << to_table(plan);
}

TEST_F(BatchPlanTest, LeavesOutWhatAnotherBatchRenders) {
    BatchPlan plan(2, unit_);
    plan[0].reason = "running elsewhere: host:1";
    plan[0].is_running_elsewhere = true;
    plan[0].estimated_seconds = 40.0;
    plan[0].error = "error: no such file";
    const std::string alone = to_table(plan);
    EXPECT_NE(alone.find("\n2 images, none to render; 1 rendered elsewhere\n"), std::string::npos) << alone;
    plan[1].reason = "never rendered";
    plan[1].estimated_seconds = 20.0;
    const std::string table = to_table(plan);
    EXPECT_NE(table.find("\n1 of 2 images to render, about 0:20; 1 rendered elsewhere\n"), std::string::npos) << table;
    const json all = json::parse(to_json(plan));
    EXPECT_EQ(all["elsewhere"], 1);
    EXPECT_EQ(all["stale"], 1);
    EXPECT_EQ(all["failing"], 0);
    EXPECT_EQ(all["estimated_seconds"], 20.0);
}

TEST_F(BatchPlanTest, TellsWhatWillFailAndWhatIsNotKnown) {
    BatchPlan plan(4, unit_);
    for (PlannedUnit& unit : plan) unit.reason = "never rendered";
    plan[0].estimated_seconds = 174.0;
    plan[0].outline = {.width = 640, .height = 360, .spp = 256, .integrator = "bdpt", .camera = "front"};
    plan[2].error = plan[3].error = "error: scene.gltf: not valid JSON\nand a second line";
    const std::string table = to_table(plan);
    for (const char* part :
         {"640x360", "256", "bdpt", "front", "will fail", ": 2 images will fail\n  error: scene.gltf",
          "\n2 of 4 images to render, \u2265 2:54, 1 unknown; 2 will fail\n"})
        EXPECT_NE(table.find(part), std::string::npos) << part << "\n" << table;
    const json all = json::parse(to_json(plan));
    EXPECT_EQ(all["failing"], 2);
    EXPECT_EQ(all["unknown"], 1);
    EXPECT_EQ(all["known_seconds"], 174.0);
    EXPECT_TRUE(all["estimated_seconds"].is_null());
    EXPECT_EQ(all["units"][0]["camera"], "front");
    EXPECT_EQ(all["units"][2]["error"], plan[2].error);
    EXPECT_EQ(summary(plan), "2 of 4 images to render, \u2265 2:54, 1 unknown: 2 never rendered; 2 will fail");
    plan[0].outline.integrator = "path\nerror: fake";
    EXPECT_NE(to_table(plan).find("path\\x0aerror: fake"), std::string::npos) << to_table(plan);
}

TEST_F(BatchPlanTest, TellsAWarningOfASceneOnceAndWhatIsReplaced) {
    BatchPlan plan(3, unit_);
    EXPECT_EQ(replacements(plan), "");
    for (PlannedUnit& unit : plan) {
        unit.reason = "settings changed";
        unit.warnings = {"warning: sky.exr is missing"};
        unit.loses_samples = true;
    }
    plan[2].loses_pixels = true;
    EXPECT_EQ(warnings(plan), (folder_ / "scene").string() + ": warning: sky.exr is missing\n");
    EXPECT_EQ(replacements(plan),
              "3 finished images will be replaced by ones with fewer samples\n"
              "1 finished image will be replaced by a smaller one\n");
    const std::string table = to_table(plan);
    for (const std::string& lines : {warnings(plan), replacements(plan)})
        EXPECT_NE(table.find("\n" + lines), std::string::npos) << table;
    EXPECT_EQ(json::parse(to_json(plan))["units"][0]["warnings"], json::array({"warning: sky.exr is missing"}));
    plan[0].error = "error: it cannot be rendered";
    EXPECT_TRUE(replacements(plan).starts_with("2 finished images will be")) << "that one stays";
}

TEST_F(BatchPlanTest, FindsWhatIsReplacedByFewerSamples) {
    options_ = {.output = folder_.path(), .no_probe = true};
    options_.overrides.give("--spp", "12");
    render();
    LedgerHistory history(folder_ / "ledger.jsonl");
    const auto plan_with = [&](const char* option, const char* value) {
        BatchOptions options = options_;
        options.overrides.give(option, value);
        return make_plan({unit_.task}, options, history, [](const std::string&, const BatchPlan&, std::size_t) {});
    };
    EXPECT_TRUE(plan_with("--spp", "11").front().loses_samples);
    EXPECT_FALSE(plan_with("--spp", "48").front().loses_samples);
    json statistics = json::parse(read_file(folder_ / "box.json"));
    statistics["size"] = {64, 48};
    write_file(folder_ / "box.json", statistics.dump());
    EXPECT_TRUE(plan_with("--size", "64x47").front().loses_pixels);
    EXPECT_FALSE(plan_with("--size", "64x49").front().loses_pixels);
}

TEST_F(BatchPlanTest, SaysThatTheTimeOfDenoisingIsNotKnown) {
    BatchPlan plan(1, unit_);
    plan[0].reason = "never rendered";
    plan[0].estimated_seconds = 20.0;
    plan[0].lacks_denoising = true;
    EXPECT_EQ(summary(plan), "1 of 1 image to render, about 0:20 without denoising: 1 never rendered");
}

TEST_F(BatchPlanTest, StatisticsTellWarningsAndAnErrorThatWasNotReached) {
    const auto read = [&](const json& statistics) {
        write_file(folder_ / "box.json", statistics.dump());
        BatchUnit unit;
        read_statistics(folder_ / "box.json", unit);
        return unit;
    };
    json statistics{{"halt_reason", "samples done"},
                    {"settings", {{"/error", 0.0}}},
                    {"estimated_relative_error", 0.03},
                    {"warnings", {"warning: one", "warning: two"}}};
    EXPECT_EQ(read(statistics).warnings, (std::vector<std::string>{"warning: one", "warning: two"}));
    EXPECT_FALSE(read(statistics).relative_error_requested);
    statistics["settings"]["/error"] = 0.01;
    const BatchUnit missed = read(statistics);
    EXPECT_EQ(missed.relative_error, 0.03);
    EXPECT_EQ(missed.relative_error_requested, 0.01);
    ASSERT_EQ(missed.warnings.size(), 3u);
    EXPECT_EQ(missed.warnings.back(), "warning: the error 0.01 was not reached: it is 0.03; samples done");
    statistics["halt_reason"] = "error reached";
    EXPECT_EQ(read(statistics).warnings.size(), 2u);
    statistics["warnings"] = std::vector<std::string>(30, "warning: many");
    EXPECT_EQ(read(statistics).warnings.size(), 21u);
    EXPECT_EQ(read(statistics).warnings.back(), "and 10 more");
}

TEST_F(BatchPlanTest, StatisticsThatAreAPipeAreUnknownAndNothingToWaitFor) {
    ASSERT_EQ(::mkfifo((folder_ / "box.json").c_str(), 0600), 0);
    BatchUnit unit;
    read_statistics(folder_ / "box.json", unit);
    EXPECT_FALSE(unit.seconds);
    EXPECT_TRUE(display_arguments(folder_ / "box.json").empty());
}

TEST_F(BatchPlanTest, IsArranged) {
    const auto names = [](const BatchPlan& plan) {
        std::string text;
        for (const PlannedUnit& unit : plan) text += unit.task.id;
        return text;
    };
    BatchPlan plan(4, unit_);
    for (std::size_t i = 0; i < 4; ++i) {
        plan[i].task.id = std::string(1, "cadb"[i]);
        plan[i].task.job.scene = folder_ / plan[i].task.id;
        write_scene(plan[i].task.job.scene);
        for (const char* file : {"scene.gltf", "triangle.bin", "render.json"})
            age(plan[i].task.job.scene / file, plan[i].task.id == "d" ? 10 : 100 + static_cast<int>(i));
    }
    plan[0].estimated_seconds = 3.0;
    plan[2].estimated_seconds = 1.0;
    plan[3].estimated_seconds = 2.0;
    const auto arranged = [&](BatchOrder order) {
        BatchPlan copy = plan;
        arrange(copy, order);
        return names(copy);
    };
    EXPECT_EQ(arranged(BatchOrder::Found), "cadb");
    EXPECT_EQ(arranged(BatchOrder::Shortest), "dbca") << "what is not known comes last";
    EXPECT_EQ(arranged(BatchOrder::Longest), "cbda");
    EXPECT_EQ(arranged(BatchOrder::Name), "abcd");
    EXPECT_EQ(arranged(BatchOrder::Newest), "dcab");
}

}  // namespace

}  // namespace etendue::test
