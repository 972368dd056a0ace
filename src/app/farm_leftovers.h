// What tasks that were submitted before have left of images that are to be made: parts and checkpoints.
#pragma once

#include "app/farm_plan.h"
#include "render/checkpoint.h"

#include <filesystem>
#include <functional>
#include <vector>

namespace etendue {

struct FarmLeftovers {
    std::vector<SampleRange> missing;            ///< ranges of which there is no part
    std::vector<std::filesystem::path> useless;  ///< files that nothing goes on with: of other settings, or damaged
};

/// Looks at the files in the folder of the image's parts and at the checkpoints beside it. `identity`, of the render
/// that is wanted, is asked for only if there are some: it reads all inputs of the scene.
[[nodiscard]] FarmLeftovers find_leftovers(const FarmImage& image, const std::filesystem::path& output,
                                           const std::function<RenderIdentity()>& identity);

}  // namespace etendue
