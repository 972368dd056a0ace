// Slurm, by way of its own programs, which are looked up in PATH.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace etendue {

/// A task of a job array that waits or runs.
struct SlurmTask {
    std::string job_name;
    std::size_t index = 0;  ///< in its array
    std::string state;      ///< state in Slurm's words: "PENDING", "RUNNING", ...
    std::string reason;     ///< why it waits
};

/// The most tasks of one job array on this cluster. Throws IoError if it cannot be asked.
[[nodiscard]] std::size_t slurm_max_array_size();

/// The command that submits `script`, to be run in `directory`, after what `dependency` says (if it is not empty).
[[nodiscard]] std::vector<std::string> sbatch_command(const std::filesystem::path& script,
                                                      const std::filesystem::path& directory,
                                                      const std::string& dependency);

/// Runs it. Returns the number of the job. Throws IoError with Slurm's own words if it is refused.
[[nodiscard]] std::string slurm_submit(const std::vector<std::string>& command);

/// Cancels jobs that must not stay alone. What cannot be cancelled is left as it is.
void slurm_cancel(std::span<const std::string> jobs);

/// All tasks of job arrays of the user `user` that wait or run. Throws IoError if they cannot be listed.
[[nodiscard]] std::vector<SlurmTask> slurm_tasks(const std::string& user);

/// Reads what `squeue` prints in the form that `slurm_tasks` asks for, as tasks; lines of other jobs are passed over.
[[nodiscard]] std::vector<SlurmTask> parse_squeue(const std::string& text);

}  // namespace etendue
