// Submitting what a farm has to do to Slurm.
#pragma once

#include "farm/farm_plan.h"
#include "farm/farm_work.h"
#include "farm/slurm_script.h"
#include "farm/submission.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace etendue {

/// Everything that a submission consists of.
struct SlurmFarm {
    FarmPlan plan;
    Submission submission;
    SlurmOptions options;
};

/// Puts it together. `directory` need not exist.
[[nodiscard]] SlurmFarm make_slurm_farm(const FarmWork& work, FarmPlan plan, SlurmOptions options,
                                        const std::filesystem::path& directory);

/// The command that submits one of its arrays, once those that it waits for have the numbers `jobs`.
[[nodiscard]] std::vector<std::string> submit_command(const SlurmFarm& farm, std::size_t array,
                                                      const std::vector<std::string>& jobs);

/// Makes the folders of images and parts, writes the submission and submits all arrays. Returns the numbers of the
/// jobs. Calls `on_kept` whenever it is certain that Slurm will run an array, whatever becomes of the others. If Slurm
/// refuses an array, or the user interrupts this, the arrays that were to be merged together with it are cancelled, the
/// others stay, and IoError says how many they are.
std::vector<std::string> submit(const SlurmFarm& farm, const std::function<void()>& on_kept);

}  // namespace etendue
