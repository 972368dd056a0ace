#include "program/fake_slurm.h"

#include <cstddef>
#include <cstdlib>
#include <sstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace etendue::test {

namespace fs = std::filesystem;

namespace {

std::string path_variable() {
    const char* const path = std::getenv("PATH");
    return path == nullptr ? "" : path;
}

}  // namespace

FakeSlurm::FakeSlurm(const fs::path& directory) : directory_(directory), path_(path_variable()) {
    fs::create_directories(directory);
    set_max_array_size(1001);
    refuse_after(1000);
    interrupt_after(1000);
    set_queue("");
    add_program("sbatch", R"sh(
number=$(($(cat jobs) + 1))
if [ "$number" -gt "$(cat limit)" ]; then
    echo 'sbatch: error: Batch job submission failed: Job violates accounting/QOS policy' >&2
    exit 1
fi
echo "$number" >jobs
env >environment
[ "$number" -ne "$(cat interrupt)" ] || kill -INT $PPID
echo "$number;a-cluster"
)sh");
    write_file(directory_ / "jobs", "0");
    add_program("squeue", "cat queue\n");
    add_program("scontrol", R"sh(
[ "$1" != show ] || printf 'Configuration data as of now\nMaxArraySize            = %s\nMaxJobCount = 9\n' "$(cat size)"
)sh");
    add_program("scancel", "");
    ::setenv("PATH", (directory_.string() + ":" + path_).c_str(), 1);
}

FakeSlurm::~FakeSlurm() {
    ::setenv("PATH", path_.c_str(), 1);
}

void FakeSlurm::add_program(const std::string& name, const std::string& body) const {
    const fs::path file = directory_ / name;
    write_file(file, fmt::format("#!/bin/sh\ncd '{}' || exit 9\nprintf '%s\\n' \"$#\" \"$@\" >>{}.calls\n{}",
                                 directory_.string(), name, body));
    fs::permissions(file, fs::perms::owner_all);
}

void FakeSlurm::set_max_array_size(int size) const {
    write_file(directory_ / "size", fmt::format("{}", size));
}
void FakeSlurm::refuse_after(int jobs) const {
    write_file(directory_ / "limit", fmt::format("{}", jobs));
}
void FakeSlurm::interrupt_after(int jobs) const {
    write_file(directory_ / "interrupt", fmt::format("{}", jobs));
}
void FakeSlurm::set_queue(const std::string& lines) const {
    write_file(directory_ / "queue", lines);
}

std::vector<std::vector<std::string>> FakeSlurm::calls(const std::string& program) const {
    std::vector<std::vector<std::string>> calls;
    const fs::path file = directory_ / (program + ".calls");
    if (!fs::exists(file)) return calls;
    std::istringstream lines(read_file(file));
    for (std::string line; std::getline(lines, line);) {
        std::vector<std::string>& words = calls.emplace_back(std::stoul(line));
        for (std::string& word : words) std::getline(lines, word);
    }
    return calls;
}

std::string FakeSlurm::environment() const {
    return read_file(directory_ / "environment");
}

CommandResult FakeSlurm::run_task(const fs::path& submission, const std::string& array, std::size_t index) const {
    const fs::path log = submission / "logs" / fmt::format("{}.{}.log", array, index);
    return run_command({"env", fmt::format("SLURM_ARRAY_TASK_ID={}", index), "SLURM_ARRAY_JOB_ID=1", "sh", "-c",
                        "cd \"$1\" && exec bash \"$2.sh\" >>\"$3\" 2>&1", "sh", submission.string(), array,
                        log.string()});
}

}  // namespace etendue::test
