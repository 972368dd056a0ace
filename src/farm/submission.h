// What was submitted to a scheduler: OUT/.etendue/submit-ID/ with
//   submission.json   the images, and which tasks each of them consists of
//   ARRAY.sh          the script of each job array
//   ARRAY.tasks       its command lines
//   logs/             what the tasks wrote
//   jobs              the scheduler's numbers of the jobs
#pragma once

#include "farm/farm_plan.h"
#include "farm/slurm_script.h"
#include "process/file_descriptor.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace etendue {

struct SubmittedTask {
    std::string array;
    std::size_t index = 0;
    std::filesystem::path makes;  ///< the file
};

struct SubmittedImage {
    std::string name;
    std::filesystem::path scene;
    std::filesystem::path output;
    std::optional<int> frame;
    std::vector<SubmittedTask> tasks;  ///< none if it was up to date or could not be planned
    std::string error;                 ///< why it could not be planned
};

struct Submission {
    std::filesystem::path directory;
    std::string user;  ///< user whose jobs they are
    std::vector<SubmittedImage> images;

    /// Returns the submission's name for the scheduler's jobs: "etendue-ID".
    [[nodiscard]] std::string job_prefix() const;
    /// Returns the name of the job of one of the submission's arrays.
    [[nodiscard]] std::string job_name(const std::string& array) const { return job_prefix() + "-" + array; }
    /// Returns the file that is as old as the submission: what is newer was made since.
    [[nodiscard]] std::filesystem::path file() const { return directory / "submission.json"; }
};

/// Keeps other processes from submitting to `output` until the result is destroyed: they would submit the same images.
/// Creates `farm_directory(output)`. Throws IoError if another process is submitting now, or if no file can be made in
/// that directory.
[[nodiscard]] FileDescriptor lock_submissions(const std::filesystem::path& output);

/// Makes a directory of its own for a new submission below the output directory. Throws IoError.
[[nodiscard]] std::filesystem::path make_submission_directory(const std::filesystem::path& output);

/// Writes everything of a submission but its jobs. Throws IoError.
void write_submission(const Submission& submission, const FarmPlan& plan, const SlurmOptions& options);

/// Adds a job to those of a submission. Throws IoError.
void record_job(const Submission& submission, const std::string& job);

/// Returns all submissions of the output directory, oldest first. Throws IoError if one cannot be read.
[[nodiscard]] std::vector<Submission> read_submissions(const std::filesystem::path& output);

/// Removes the directories of earlier submissions whose images are all in `last`: their logs tell nothing any more.
void remove_superseded(std::span<const Submission> earlier, const Submission& last);

/// Returns the directory of submissions, parts and logs in the output directory.
[[nodiscard]] std::filesystem::path farm_directory(const std::filesystem::path& output);

/// Returns whether `text` can be written into a submission: it must be UTF-8.
[[nodiscard]] bool can_be_recorded(const std::string& text);

}  // namespace etendue
