// etendue submit from outside, with programs in the place of Slurm's.
#include "color/built_in_config.h"
#include "core/byte_size.h"
#include "farm/submission.h"
#include "program/fake_slurm.h"
#include "program/run_program.h"
#include "program/small_files.h"

#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

namespace etendue::test {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class Submit : public testing::Test {
  protected:
    void SetUp() override { fs::create_directories(work_); }

    /// A scene of 16 x 12 pixels, by default with 48 samples.
    void scene(const std::string& name, const std::string& extra = "") const {
        write_scene(folder_ / ("scenes/" + name), extra);
    }
    [[nodiscard]] ProgramResult submit(const std::vector<std::string>& more) const {
        std::vector<std::string> arguments{
            "submit", (folder_ / "scenes").string(), "-o", out().string(), "--scheduler", "slurm", "--threads", "1",
            "--json"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_etendue(arguments, work_);
    }
    /// The same, which must succeed, as its report.
    [[nodiscard]] json submitted(const std::vector<std::string>& more) const {
        const ProgramResult result = submit(more);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return json::parse(result.out, nullptr, false);
    }
    [[nodiscard]] std::pair<int, json> status() const {
        const ProgramResult result = run_etendue({"submit", "--status", out().string(), "--json"}, work_);
        return {result.exit_code, json::parse(result.out, nullptr, false)};
    }
    /// Runs all tasks of a submission.
    void run_all(const json& report) const {
        for (const json& array : report["arrays"])
            for (std::size_t i = 0; i < array["tasks"].get<std::size_t>(); ++i)
                EXPECT_EQ(slurm_.run_task(report["directory"].get<std::string>(), array["name"], i).exit_code, 0)
                    << array["name"] << " " << i;
    }
    [[nodiscard]] fs::path out() const { return folder_ / "out"; }
    /// What a task is known by in a line of squeue.
    static std::string queued(const json& report, const std::string& task, const std::string& state) {
        const std::string id = fs::path(report["directory"].get<std::string>()).filename().string().substr(7);
        return fmt::format("etendue-{}-{}|{}|None\n", id, task, state);
    }

    TestFolder folder_;
    fs::path work_ = folder_ / "work";
    FakeSlurm slurm_{folder_ / "slurm"};
    const std::vector<std::string> small_{"--spp", "48", "--task-minutes", "5", "--task-memory", "512M", "--float"};
    const std::vector<std::string> split_{"--spp", "48",      "--task-minutes",  "5", "--task-memory",
                                          "512M",  "--float", "--split-samples", "3"};
};

TEST_F(Submit, ImagesOfPartsEqualThoseOfOneMachine) {
    scene("a");
    scene("deep/b", R"("integrator": {"type": "bdpt"},)");
    const json report = submitted(split_);
    ASSERT_EQ(report["arrays"].size(), 4u);
    EXPECT_EQ(report["arrays"][3]["name"], "merge-3");
    const auto calls = slurm_.calls("sbatch");
    ASSERT_EQ(calls.size(), 4u);
    EXPECT_EQ(calls[0][0], "--parsable");
    EXPECT_EQ(calls[0].size(), 3u) << "no dependency";
    EXPECT_EQ(calls[3][2], "--dependency=aftercorr:1:2:3");
    EXPECT_EQ(calls[3][3], "--kill-on-invalid-dep=yes");
    EXPECT_EQ(status().first, 1) << "nothing waits: it was cancelled";
    slurm_.set_queue(queued(report, "render-0|0", "RUNNING") + queued(report, "merge-3|1", "PENDING"));
    const auto [waiting, states] = status();
    EXPECT_EQ(waiting, 4);
    EXPECT_EQ(states["images"][0]["state"], "running");
    EXPECT_EQ(states["images"][1]["state"], "pending");

    EXPECT_NE(slurm_.run_task(report["directory"].get<std::string>(), "merge-3", 0).exit_code, 0)
        << "there are no parts";
    run_all(report);
    slurm_.set_queue("");
    EXPECT_EQ(slurm_.run_task(report["directory"].get<std::string>(), "merge-3", 0).exit_code, 0) << "and once more";
    const auto [done, after] = status();
    EXPECT_EQ(done, 0);
    EXPECT_EQ(after["done"], 2) << after.dump(1);
    EXPECT_TRUE(fs::is_empty(out() / ".etendue/parts") ||
                list(out() / ".etendue/parts") == std::vector<std::string>{"deep"});
    EXPECT_EQ(run_etendue({"batch", (folder_ / "scenes").string(), "-o", (folder_ / "one").string(), "--spp", "48",
                           "--float", "--quiet"},
                          work_)
                  .exit_code,
              0);
    for (const char* image : {"a.exr", "deep/b.exr"}) {
        const ProgramResult diff = run_etendue({"diff", (out() / image).string(), (folder_ / "one" / image).string(),
                                                "--metric", "relmse", "--fail-above", "relmse=1e-12"},
                                               work_);
        EXPECT_EQ(diff.exit_code, 0) << diff.out << diff.err;
    }
    EXPECT_EQ(submitted(split_)["arrays"].size(), 0u) << "up to date";
    // What one machine has made is up to date, too.
    const ProgramResult other =
        run_etendue({"submit", "../scenes", "-o", "../one", "--scheduler", "slurm", "--spp", "48", "--float"}, work_);
    EXPECT_NE(other.out.find(" 2 up to date"), std::string::npos) << other.out << other.err;
    EXPECT_EQ(slurm_.calls("sbatch").size(), 4u);
}

TEST_F(Submit, FileNamesAreNotRunByAnyShell) {
    const std::string name = "it's $(touch PWNED) `touch PWNED` ; touch PWNED # & \"x\" \\ %a \n touch PWNED\n";
    scene(name);
    run_all(submitted({"--spp", "2", "--task-minutes", "5", "--task-memory", "512M", "--split-samples", "2"}));
    EXPECT_EQ(status().first, 0);
    for (const std::string& file : list(folder_.path())) EXPECT_NE(fs::path(file).filename(), "PWNED") << file;
}

TEST_F(Submit, TheProgramIsFoundFromWhereTasksRun) {
    scene("a");
    std::vector<std::string> own = small_;
    own.insert(own.end(), {"--program", "bin/etendue"});
    const std::string line = read_file(fs::path(submitted(own)["directory"].get<std::string>()) / "render-0.tasks");
    EXPECT_TRUE(line.starts_with("exec '" + (work_ / "bin/etendue").string() + "' render")) << line;
    own.back() = "etendue-2";
    own.insert(own.end(), {"--force"});
    const std::string found = read_file(fs::path(submitted(own)["directory"].get<std::string>()) / "render-0.tasks");
    EXPECT_TRUE(found.starts_with("exec 'etendue-2' render")) << "in PATH: " << found;
}

TEST_F(Submit, FilesThatTheEnvironmentNamesAreFoundFromWhereTasksRun) {
    scene("a");
    write_file(work_ / "c.ocio", std::string(built_in_config_text()));
    ::setenv("OCIO", "c.ocio", 1);
    ::setenv("ETENDUE_ASSETS", "skies::/nowhere", 1);
    const ProgramResult result = submit(small_);
    ::unsetenv("OCIO");
    ::unsetenv("ETENDUE_ASSETS");
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const std::string variables = slurm_.environment();
    EXPECT_NE(variables.find("OCIO=" + (work_ / "c.ocio").string() + "\n"), std::string::npos) << variables;
    EXPECT_NE(variables.find("ETENDUE_ASSETS=" + (work_ / "skies").string() + ":/nowhere\n"), std::string::npos)
        << variables;
}

/// Nodes of different memory would hold textures in different ways, and their parts could not be merged.
TEST_F(Submit, AllTasksGetTheSameMemoryForTextures) {
    scene("a");
    scene("b", R"("texture_memory": "64M",)");
    const auto lines = [](const json& report) {
        return read_file(fs::path(report["directory"].get<std::string>()) / "render-0.tasks");
    };
    const std::string own = lines(submitted(small_));
    const std::string option = "--texture-memory '" + to_byte_size(physical_memory() / 2) + "'";
    const std::size_t place = own.find(option);
    EXPECT_NE(place, std::string::npos) << own;
    EXPECT_EQ(own.find("--texture-memory", place + option.size()), std::string::npos) << "the scene b says: " << own;
    std::vector<std::string> given = small_;
    given.insert(given.end(), {"--texture-memory", "3G"});
    const std::string asked = lines(submitted(given));
    EXPECT_EQ(asked.find(option), std::string::npos) << asked;
}

TEST_F(Submit, FramesAreImagesOfTheirOwn) {
    scene("a");
    (void)animated_scene((folder_ / "scenes/a").string());
    const std::vector<std::string> frames{"--spp",           "2", "--task-minutes", "5",     "--task-memory", "512M",
                                          "--split-samples", "2", "--frames",       "-1:3:4"};
    const json report = submitted(frames);
    EXPECT_EQ(report["images"], 2);
    run_all(report);
    EXPECT_EQ(status().first, 0) << status().second.dump(1);
    EXPECT_EQ(json::parse(read_file(out() / "a.-0001.json"))["frame"], -1);
    EXPECT_EQ(json::parse(read_file(out() / "a.0003.json"))["frame"], 3);
    EXPECT_EQ(submitted(frames)["up_to_date"], 2);
    std::vector<std::string> whole = small_;
    whole.insert(whole.end(), {"--frames", "5"});
    run_all(submitted(whole));
    EXPECT_TRUE(fs::exists(out() / "a.0005.json"));
}

TEST_F(Submit, OnlyWhatIsMissingIsSubmittedAgain) {
    scene("a");
    scene("b");
    const json first = submitted(split_);
    const std::string directory = first["directory"];
    // Of 'a' the second part is missing, of 'b' only the merge.
    for (const auto& [array, index] : std::vector<std::pair<std::string, std::size_t>>{
             {"render-0", 0}, {"render-2", 0}, {"render-0", 1}, {"render-1", 1}, {"render-2", 1}})
        EXPECT_EQ(slurm_.run_task(directory, array, index).exit_code, 0);
    EXPECT_NE(slurm_.run_task(directory, "merge-3", 0).exit_code, 0);
    const auto [code, failed] = status();
    EXPECT_EQ(code, 1);
    EXPECT_EQ(failed["images"][0]["tasks_done"], 2);
    EXPECT_NE(failed["images"][0]["error"].get<std::string>().find("no log"), std::string::npos) << failed.dump(1);

    const json second = submitted(split_);
    ASSERT_EQ(second["arrays"].size(), 2u) << second.dump(1);
    EXPECT_EQ(second["arrays"][0]["tasks"], 1);
    EXPECT_EQ(second["arrays"][1]["tasks"], 2);
    EXPECT_EQ(slurm_.calls("sbatch").back()[2], "--dependency=afterany:5");
    EXPECT_FALSE(fs::exists(directory)) << "superseded";
    run_all(second);
    EXPECT_EQ(status().first, 0);
}

TEST_F(Submit, PartsOfOtherSettingsAreNotUsed) {
    scene("a");
    const json first = submitted(split_);
    for (const char* array : {"render-0", "render-1", "render-2"})
        EXPECT_EQ(slurm_.run_task(first["directory"].get<std::string>(), array, 0).exit_code, 0);
    std::vector<std::string> other = split_;
    other.insert(other.end(), {"--seed", "7"});
    EXPECT_EQ(submitted(other)["arrays"].size(), 4u);
    EXPECT_TRUE(fs::is_empty(out() / ".etendue/parts/a.exr"));
}

TEST_F(Submit, PartsOfOtherPixelsAreNotUsed) {
    scene("a");
    std::vector<std::string> crop = split_;
    crop.insert(crop.end(), {"--crop", "0,0,8,12"});
    for (const std::size_t left : {3u, 1u}) {
        const json first = submitted(crop);
        for (std::size_t i = 0; i < left; ++i)
            EXPECT_EQ(slurm_.run_task(first["directory"].get<std::string>(), fmt::format("render-{}", i), 0).exit_code,
                      0);
        EXPECT_EQ(submitted(crop)["arrays"].size(), left == 3 ? 1u : 2u) << "they are of use to the same crop";
        const json second = submitted(split_);
        ASSERT_EQ(second["arrays"].size(), 4u) << left << " parts of a crop are left";
        EXPECT_TRUE(fs::is_empty(out() / ".etendue/parts/a.exr"));
        run_all(second);
        EXPECT_EQ(json::parse(read_file(out() / "a.json"))["size"], (json{16, 12}));
        fs::remove(out() / "a.json");
    }
}

TEST_F(Submit, PartsOfAnImageThatIsShownOtherwiseAreNotUsed) {
    scene("a");
    const json first = submitted(split_);
    for (const char* array : {"render-0", "render-1", "render-2"})
        EXPECT_EQ(slurm_.run_task(first["directory"].get<std::string>(), array, 0).exit_code, 0);
    std::vector<std::string> bright = split_;
    bright.insert(bright.end(), {"--exposure", "4"});
    run_all(submitted(bright));
    EXPECT_EQ(submitted(bright)["up_to_date"], 1) << "it is what was asked for";
}

TEST_F(Submit, ACheckpointThatATaskWouldRefuseIsThrownAway) {
    scene("a");
    fs::create_directories(out());
    const auto leave_checkpoint = [&] {
        const std::string part = (out() / "a.partial").string();
        EXPECT_EQ(run_etendue({"render", (folder_ / "scenes/a").string(), "-o", part, "--spp", "48", "--samples",
                               "0:16", "--quiet"},
                              work_)
                      .exit_code,
                  0);
        fs::rename(part, out() / "a.checkpoint");
    };
    leave_checkpoint();
    (void)submitted(small_);
    EXPECT_TRUE(fs::exists(out() / "a.checkpoint")) << "the task goes on with it";
    // It does not hold what an estimate of the error needs.
    std::vector<std::string> limited = small_;
    limited.insert(limited.end(), {"--error", "0.5"});
    const json report = submitted(limited);
    EXPECT_FALSE(fs::exists(out() / "a.checkpoint"));
    run_all(report);
    EXPECT_EQ(status().first, 0) << status().second.dump(1);
}

/// Slurm tells the shell alone by SIGUSR2 that its time is up. Of a task that is cancelled all processes get SIGTERM.
TEST_F(Submit, ATaskWhoseTimeIsUpIsQueuedAgainUnlessItWasCancelled) {
    scene("a");
    // Large enough for the image to be written for a while.
    const std::string directory = submitted({"--spp", "16000000", "--size", "640x480", "--task-minutes", "5",
                                             "--task-memory", "512M", "--checkpoint-every", "0.01"})["directory"];
    const std::string checkpoint = (out() / "a.checkpoint").string();
    const auto stop_task = [&](const char* state, const char* signal) {
        slurm_.set_queue(state);
        fs::remove(checkpoint);
        fs::remove(out() / "a.json");
        const std::string stop_it = fmt::format(
            "cd '{}'; setsid bash render-0.sh >log 2>&1 & task=$!; i=0; while [ ! -e '{}' ] && [ $i -lt 600 ]; do "
            "sleep 0.1; i=$((i + 1)); done; kill {}$task; wait $task",
            directory, checkpoint, signal);
        return run_command({"env", "SLURM_ARRAY_TASK_ID=0", "SLURM_ARRAY_JOB_ID=12", "bash", "-c", stop_it}).exit_code;
    };
    EXPECT_EQ(stop_task("CANCELLED", "-TERM -- -"), 143);
    EXPECT_TRUE(fs::exists(out() / "a.json")) << "etendue was ended at once " << read_file(directory + "/log");
    const auto requeues = [&] {
        std::vector<std::vector<std::string>> calls = slurm_.calls("scontrol");
        std::erase_if(calls, [](const std::vector<std::string>& words) { return words[0] != "requeue"; });
        return calls;
    };
    EXPECT_TRUE(requeues().empty());
    EXPECT_EQ(stop_task("RUNNING", "-USR2 "), 0) << read_file(directory + "/log");
    EXPECT_EQ(requeues(), (std::vector<std::vector<std::string>>{{"requeue", "12_0"}}));
    EXPECT_TRUE(fs::exists(checkpoint));
}

TEST_F(Submit, WhatStillWaitsIsNotSubmittedTwice) {
    scene("a");
    scene("b");
    const json first = submitted(small_);
    slurm_.set_queue(queued(first, "render-0|1", "PENDING"));
    const json second = submitted(small_);
    EXPECT_EQ(second["submitted_before"], 1);
    EXPECT_EQ(second["images"], 1);
    EXPECT_TRUE(fs::exists(first["directory"].get<std::string>()));
    EXPECT_EQ(status().second["pending"], 1);
    EXPECT_EQ(status().second["failed"], 1);
}

TEST_F(Submit, FailedTasksShowTheirLastWords) {
    scene("a");
    const json report = submitted(small_);
    fs::remove(folder_ / "scenes/a/triangle.bin");
    EXPECT_EQ(slurm_.run_task(report["directory"].get<std::string>(), "render-0", 0).exit_code, 3);
    const auto [code, failed] = status();
    EXPECT_EQ(code, 1);
    EXPECT_NE(failed["images"][0]["error"].get<std::string>().find("triangle.bin"), std::string::npos)
        << failed.dump(1);
    EXPECT_TRUE(fs::exists(failed["images"][0]["log"].get<std::string>()));
}

TEST_F(Submit, ASceneThatCannotBeLoadedDoesNotStopTheOthers) {
    scene("bad", R"("ssp": 1,)");
    scene("good");
    const ProgramResult result = submit(small_);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.err.find("/ssp"), std::string::npos) << result.err;
    const json report = json::parse(result.out);
    EXPECT_EQ(report["images"], 1);
    run_all(report);
    const auto [code, states] = status();
    EXPECT_EQ(code, 1);
    EXPECT_EQ(states["done"], 1);
    EXPECT_NE(states["images"][0]["error"].get<std::string>().find("/ssp"), std::string::npos);
}

TEST_F(Submit, RefusedJobsLeaveNoHalvesBehind) {
    scene("a");
    scene("b", R"("spp": 2,)");
    slurm_.refuse_after(3);
    const ProgramResult result = submit(split_);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.err.find("QOS policy"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("0 of 4"), std::string::npos) << result.err;
    ASSERT_EQ(slurm_.calls("scancel").size(), 1u);
    EXPECT_EQ(slurm_.calls("scancel")[0], (std::vector<std::string>{"1", "2", "3"}));
}

TEST_F(Submit, AnInterruptStopsItBeforeTheNextScene) {
    scene("a");
    write_file(folder_ / "scenes/a/render.json", R"({"size": [16, 12], "spp": 10000000, "environment": {}})");
    scene("b", R"("ssp": 1,)");
    const std::vector<std::string> arguments{
        "submit", (folder_ / "scenes").string(), "-o", out().string(), "--scheduler", "slurm"};
    RunningProgram program(arguments, work_);
    // While it probes the first scene.
    int probe = 0;
    ASSERT_TRUE(wait_until([&] {
        for (const int child : children_of(program.pid()))
            if (handles_interrupt(child)) probe = child;
        return program.has_ended() || probe > 0;
    }));
    ASSERT_GT(probe, 0);
    program.send(SIGINT);
    kill(probe, SIGINT);
    const ProgramResult result = program.wait();
    EXPECT_EQ(result.exit_code, 130) << result.err;
    EXPECT_EQ(result.err, "interrupted before anything was submitted\n");
    EXPECT_TRUE(slurm_.calls("sbatch").empty());
    EXPECT_FALSE(fs::exists(out()));
}

TEST_F(Submit, TwoAtOnceDoNotSubmitTwice) {
    scene("a");
    const FileDescriptor lock = lock_submissions(out());
    const ProgramResult result = submit(small_);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.err.find("is submitting to"), std::string::npos) << result.err;
    EXPECT_TRUE(slurm_.calls("sbatch").empty());
}

TEST_F(Submit, AFinishedImageKeepsItsStatisticsUntilSlurmTakesItsTask) {
    scene("a");
    run_all(submitted(small_));
    const std::string before = read_file(out() / "a.json");
    std::vector<std::string> by_force = small_;
    by_force.emplace_back("--force");
    slurm_.refuse_after(0);
    EXPECT_EQ(submit(by_force).exit_code, 1);
    EXPECT_EQ(read_file(out() / "a.json"), before);
    EXPECT_FALSE(fs::exists(out() / "a.json.replaced"));
}

TEST_F(Submit, AnInterruptStopsItBeforeTheNextArrayAndTakesHalvesBack) {
    scene("a");
    slurm_.interrupt_after(2);
    const ProgramResult result = submit(split_);
    EXPECT_EQ(result.exit_code, 130) << result.err;
    EXPECT_NE(result.err.find("interrupted\n  0 of 4"), std::string::npos) << result.err;
    EXPECT_EQ(slurm_.calls("sbatch").size(), 2u);
    ASSERT_EQ(slurm_.calls("scancel").size(), 1u);
    EXPECT_EQ(slurm_.calls("scancel")[0], (std::vector<std::string>{"1", "2"}));
}

TEST_F(Submit, WithoutSlurmItSaysSo) {
    scene("a");
    fs::remove(folder_ / "slurm/scontrol");
    fs::create_symlink("/nonexistent", folder_ / "slurm/nothing");
    ::setenv("PATH", (folder_ / "slurm").c_str(), 1);
    const ProgramResult result = submit(small_);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.err.find("cannot run scontrol"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("docs/farm.md"), std::string::npos) << result.err;
}

TEST_F(Submit, ADryRunWritesNothing) {
    scene("a");
    const auto before = list(folder_ / "scenes");
    const ProgramResult result =
        run_etendue({"submit", (folder_ / "scenes").string(), "-o", out().string(), "--scheduler", "slurm", "--dry-run",
                     "--spp", "48", "--split-samples", "2"},
                    work_);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.out.find("aftercorr:JOB-OF-render-0:JOB-OF-render-1"), std::string::npos) << result.out;
    fs::remove(folder_ / "slurm/scontrol");
    const ProgramResult elsewhere = submit({"--dry-run", "--task-minutes", "5", "--task-memory", "512M"});
    EXPECT_EQ(elsewhere.exit_code, 0) << elsewhere.err;
    EXPECT_NE(elsewhere.err.find("job arrays are taken to have 1001 tasks"), std::string::npos) << elsewhere.err;
    EXPECT_FALSE(fs::exists(out()));
    EXPECT_TRUE(slurm_.calls("sbatch").empty());
    EXPECT_EQ(list(folder_ / "scenes"), before);
}

TEST_F(Submit, DamagedRecordsAreNamed) {
    const fs::path directory = out() / ".etendue/submit-20260101-000000-abcdef";
    fs::create_directories(directory);
    for (const char* text : {"", "{", "[]", R"({"user": 1})", R"({"user": "u", "images": [{"name": "a"}]})"}) {
        write_file(directory / "submission.json", text);
        const ProgramResult result = run_etendue({"submit", "--status", out().string()}, work_);
        EXPECT_EQ(result.exit_code, 1) << text;
        EXPECT_NE(result.err.find((directory / "submission.json").string() + " cannot be read"), std::string::npos)
            << result.err;
    }
}

TEST_F(Submit, RecordsThatArePipesAreErrorsAtOnce) {
    scene("a");
    const fs::path directory = out() / ".etendue/submit-20260101-000000-abcdef";
    fs::create_directories(directory);
    ASSERT_EQ(::mkfifo((directory / "submission.json").c_str(), 0600), 0);
    EXPECT_EQ(run_etendue({"submit", "--status", out().string()}, work_).exit_code, 1);
    EXPECT_EQ(submit(small_).exit_code, 1);
    fs::remove_all(directory);
    ASSERT_EQ(::mkfifo((out() / ".etendue/submitting").c_str(), 0600), 0);
    const ProgramResult result = submit(small_);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.err.find("submitting: it is a pipe"), std::string::npos) << result.err;
}

TEST_F(Submit, BadOptionsEndWithTwo) {
    scene("a");
    EXPECT_EQ(run_etendue({"submit", "--status", work_.string()}, work_).exit_code, 2);
    EXPECT_EQ(run_etendue({"submit", (folder_ / "scenes").string(), "-o", "x"}, work_).exit_code, 2);
    EXPECT_EQ(submit({"--task-memory", "lots"}).exit_code, 2);
    EXPECT_EQ(submit({"--sbatch-option", "--x=$(run)", "--dry-run"}).exit_code, 2);
    slurm_.set_max_array_size(10);
    EXPECT_EQ(submit({"--split-samples", "11", "--spp", "400"}).exit_code, 2);
    const ProgramResult limit = submit({"--split-samples", "2", "--time", "3"});
    EXPECT_EQ(limit.exit_code, 1);
    EXPECT_NE(limit.err.find("--time: a limit of time cannot be split"), std::string::npos) << limit.err;
}

}  // namespace

}  // namespace etendue::test
