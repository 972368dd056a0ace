// Programs that look like Slurm's to whoever finds them in PATH, and a cluster that runs tasks when the test says so.
#pragma once

#include "process/run_command.h"
#include "program/small_files.h"

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace etendue::test {

/// While it lives, PATH begins with sbatch, squeue, scontrol and scancel of its own.
class FakeSlurm {
  public:
    /// Its files are in the directory `directory`, which it makes.
    explicit FakeSlurm(const std::filesystem::path& directory);
    ~FakeSlurm();
    FakeSlurm(const FakeSlurm&) = delete;
    FakeSlurm& operator=(const FakeSlurm&) = delete;

    void set_max_array_size(int size) const;
    /// sbatch takes so many jobs and refuses what comes after.
    void refuse_after(int jobs) const;
    /// While sbatch takes the job of this number, the user presses Ctrl-C: whoever called it gets SIGINT.
    void interrupt_after(int jobs) const;
    /// Sets the lines that squeue prints.
    void set_queue(const std::string& lines) const;
    /// The words of each call of a program, oldest first.
    [[nodiscard]] std::vector<std::vector<std::string>> calls(const std::string& program) const;
    /// Returns the environment of the last sbatch that took a job, which its tasks get: lines NAME=VALUE.
    [[nodiscard]] std::string environment() const;

    /// Runs the script of a submitted array for one task as slurmd does. Its output goes to its log.
    [[nodiscard]] CommandResult run_task(const std::filesystem::path& submission, const std::string& array,
                                         std::size_t index) const;

  private:
    void add_program(const std::string& name, const std::string& body) const;

    std::filesystem::path directory_;
    std::string path_;
};

}  // namespace etendue::test
