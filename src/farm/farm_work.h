// Which of the images of some scenes have to be made by a farm.
#pragma once

#include "batch/batch_units.h"
#include "farm/farm_plan.h"
#include "farm/farm_status.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace etendue {

struct FarmRequest {
    SettingsOverrides overrides;
    FarmOptions farm;
    std::uint32_t parts = 1;                     ///< parts of each image
    std::optional<int> task_minutes;             ///< minutes of a task, in place of what a probe says
    std::optional<std::uint64_t> task_memory{};  ///< bytes of a task, in place of what a probe says
    bool force = false;                          ///< images that are up to date are made, too
    /// Sets the texture memory of scenes that do not say: each node's own default would be another one, and parts of
    /// textures that some nodes hold in memory and others in a cache do not belong together.
    std::string texture_memory{};
};

struct FarmWork {
    std::vector<FarmImage> images;  ///< to be made
    std::vector<ImageJob> busy;     ///< tasks that were submitted before are still at them
    std::vector<ImageJob> up_to_date;
    std::vector<SubmittedImage> failed;          ///< with what is wrong with them
    std::vector<std::filesystem::path> useless;  ///< files that tasks must not find
};

/// Loads scenes and looks at their images; `earlier` is what became of earlier submissions. What is wrong with one
/// scene does not concern the others. Ends early, with what it has found, if it is interrupted.
[[nodiscard]] FarmWork find_farm_work(const FarmRequest& request, std::span<const BatchTask> tasks,
                                      std::span<const FarmImageStatus> earlier);

}  // namespace etendue
