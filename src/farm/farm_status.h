// What has become of submitted images, by what lies in the output directory and what the scheduler says.
#pragma once

#include "farm/slurm.h"
#include "farm/submission.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace etendue {

enum class FarmState {
    Done,
    Running,
    Pending,
    Failed,
};
[[nodiscard]] const char* farm_state_name(FarmState state);

struct FarmImageStatus {
    SubmittedImage image;
    FarmState state = FarmState::Failed;
    std::size_t tasks_done = 0;
    std::string job;            ///< the scheduler's name of a task that waits or runs
    std::string error;          ///< if it failed
    std::filesystem::path log;  ///< if it failed, and if there is one
};

/// All tasks of a user that wait or run.
using TaskLister = std::function<std::vector<SlurmTask>(const std::string& user)>;

/// Returns the status of every image that was ever submitted to `output`, by its last submission, sorted by file name.
/// The scheduler is asked first: what ends meanwhile still counts as running, never as failed. Throws what `list` and
/// `read_submissions` throw.
[[nodiscard]] std::vector<FarmImageStatus> farm_status(const std::filesystem::path& output, const TaskLister& list);

/// The last lines of a file, without control characters.
[[nodiscard]] std::string last_lines(const std::filesystem::path& file, std::size_t count);

/// A JSON object: how many images are in which state, and an entry for each of them.
[[nodiscard]] std::string to_json(std::span<const FarmImageStatus> images);

}  // namespace etendue
