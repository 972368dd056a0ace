#include "farm/slurm_script.h"

#include "farm/slurm.h"
#include "process/run_command.h"
#include "processor/ray_code.h"
#include "program/fake_slurm.h"
#include "program/small_files.h"
#include "session/usage_error.h"

#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

const JobArray kArray{"render-3", {90, 2048}, {"true", "false"}, ArrayWait::No, {}};

TEST(SlurmScript, SaysWhatSlurmIsToDo) {
    const std::string script =
        slurm_script(kArray, "etendue-x-render-3", {.threads = 8, .max_running = 0, .options = {}});
    EXPECT_TRUE(script.starts_with("#!/bin/bash\n"));
    for (const char* line :
         {"--job-name=etendue-x-render-3", "--array=0-1", "--cpus-per-task=8", "--mem=2048M", "--time=90", "--requeue",
          "--output=logs/render-3.%a.log", "--open-mode=append", "--signal=B:USR2@60"})
        EXPECT_NE(script.find(std::string("\n#SBATCH ") + line + "\n"), std::string::npos) << line << "\n" << script;
    EXPECT_NE(script.find("tasks=render-3.tasks\n"), std::string::npos);
    const TestFolder folder;
    write_file(folder / "script.sh", script);
    const CommandResult check = run_command({"bash", "-n", (folder / "script.sh").string()});
    EXPECT_EQ(check.exit_code, 0) << check.err;
}

// A large checkpoint on a slow disk takes longer than a minute. Half of the time is for rendering.
TEST(SlurmScript, TasksAreWarnedEarlyEnoughForTheirCheckpoint) {
    const auto warning = [](int minutes, int seconds) {
        JobArray array = kArray;
        array.needs = {minutes, 2048, seconds};
        const std::string script = slurm_script(array, "n", {.threads = 1, .max_running = 0, .options = {}});
        const std::string option = "\n#SBATCH --signal=B:USR2@";
        const std::size_t begin = script.find(option) + option.size();
        return script.substr(begin, script.find('\n', begin) - begin);
    };
    EXPECT_EQ(warning(90, 156), "156");
    EXPECT_EQ(warning(90, 60), "60");
    EXPECT_EQ(warning(4, 156), "120");
    EXPECT_EQ(warning(1, 156), "60");
}

// What other submissions have left is judged by the instruction set of the machine that submits.
TEST(SlurmScript, TasksUseTheInstructionSetThatSubmits) {
    const std::string script = slurm_script(kArray, "n", {.threads = 1, .max_running = 0, .options = {}});
    const std::string name(instruction_set_name(ray_code().instruction_set));
    EXPECT_NE(script.find("\nexport ETENDUE_ISA=" + name + "\n"), std::string::npos) << script;
}

TEST(SlurmScript, TakesOptionsOfTheClusterButNothingElse) {
    const std::string script =
        slurm_script(kArray, "n", {.threads = 1, .max_running = 5, .options = {"--partition=short", "--qos=a.b"}});
    EXPECT_NE(script.find("#SBATCH --array=0-1%5\n"), std::string::npos);
    EXPECT_NE(script.find("\n#SBATCH --partition=short\n#SBATCH --qos=a.b\nset -u\n"), std::string::npos) << script;
    for (const char* bad :
         {"partition", "-p x", "--x=a b", "--x=$(run)", "--x\nrm -rf /", "--x=`run`", "--x='", "--x#"})
        EXPECT_THROW((void)slurm_script(kArray, "n", {.threads = 1, .max_running = 0, .options = {bad}}), UsageError)
            << bad;
}

// Slurm counts preemptions and nodes that fail as restarts, too.
TEST(SlurmScript, OnlyTimesThatWereUpAreCounted) {
    const TestFolder folder;
    const FakeSlurm slurm(folder / "slurm");
    slurm.set_queue("RUNNING");
    JobArray array = kArray;
    // The task sends its shell the signal that Slurm sends before the time limit, and then waits for SIGTERM.
    array.commands = {"sleep 0.2; kill -USR2 $$; exec sleep 60"};
    write_file(folder / "render-3.sh", slurm_script(array, "n", {.threads = 1, .max_running = 0, .options = {}}));
    write_file(folder / "render-3.tasks", array.commands[0] + "\n");
    std::filesystem::create_directories(folder / "logs");
    const auto output = [&] { return read_file(folder / "logs/render-3.0.log"); };
    const std::filesystem::path requeues = folder / "logs/render-3.0.requeues";
    ::setenv("SLURM_RESTART_COUNT", "100", 1);
    EXPECT_EQ(slurm.run_task(folder.path(), "render-3", 0).exit_code, 0) << output();
    EXPECT_EQ(read_file(requeues), ".");
    EXPECT_EQ(slurm.calls("scontrol").size(), 1u);
    write_file(requeues, std::string(20, '.'));
    EXPECT_EQ(slurm.run_task(folder.path(), "render-3", 0).exit_code, 1);
    ::unsetenv("SLURM_RESTART_COUNT");
    EXPECT_NE(output().find("the time was up 21 times"), std::string::npos) << output();
    EXPECT_EQ(slurm.calls("scontrol").size(), 1u);
}

TEST(Slurm, TasksAreReadFromItsList) {
    const std::vector<SlurmTask> tasks = parse_squeue(
        "etendue-x-render-0|3|PENDING|Priority\n"
        "etendue-x-merge-1|12|PENDING|DependencyNeverSatisfied\n"
        "  etendue-x-render-0|4|RUNNING|None  \n"
        "a|strange|name|7|RUNNING|None\n"
        "no array|N/A|RUNNING|None\n"
        "half a line|\n"
        "\n");
    ASSERT_EQ(tasks.size(), 4u);
    EXPECT_EQ(tasks[0].job_name, "etendue-x-render-0");
    EXPECT_EQ(tasks[0].index, 3u);
    EXPECT_EQ(tasks[1].reason, "DependencyNeverSatisfied");
    EXPECT_EQ(tasks[2].state, "RUNNING");
    EXPECT_EQ(tasks[3].job_name, "a|strange|name");
}

}  // namespace

}  // namespace etendue::test
