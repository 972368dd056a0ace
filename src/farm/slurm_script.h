// The script of a job array of Slurm.
#pragma once

#include "farm/farm_plan.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

/// Holds what all arrays of a submission have in common.
struct SlurmOptions {
    int threads = 1;                   ///< processors of each task
    std::size_t max_running = 0;       ///< tasks of an array at once; 0 for no limit
    std::vector<std::string> options;  ///< further options of sbatch, "--partition=short"
};

/// Throws UsageError if one of the options has anything in it that Slurm could take for something else.
void check_options(const SlurmOptions& options);

/// The script of `array`, which finds its commands in ARRAY.tasks and writes to logs/ARRAY.INDEX.log, in the directory
/// that it is run in. Its tasks run with the instruction set that runs here. `job_name` is its name for Slurm, letters,
/// digits and "-." only. Throws what `check_options` throws.
[[nodiscard]] std::string slurm_script(const JobArray& array, const std::string& job_name, const SlurmOptions& options);

/// Names of such files, in the directory of the submission.
[[nodiscard]] std::string tasks_file_name(const std::string& array);
[[nodiscard]] std::string log_file_name(const std::string& array, std::size_t index);

/// The built-in template: third_party_config/slurm/task-array.sh.
[[nodiscard]] std::string_view slurm_template();

}  // namespace etendue
