// What tasks that were submitted before have left of images that are to be made: parts and checkpoints.
#pragma once

#include "farm/farm_plan.h"
#include "render/checkpoint.h"
#include "scene/render_settings.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace etendue {

/// Describes the image that is to be made; a default one matches no file.
struct WantedImage {
    RenderIdentity identity{};
    RenderSettings settings{};
    bool has_halves = false;      ///< layers ask for every other pass
    std::string settings_hash{};  ///< hash of the settings, as statistics of finished parts have it
};

struct FarmLeftovers {
    std::vector<SampleRange> missing;            ///< ranges of which there is no part
    std::vector<std::filesystem::path> useless;  ///< files that nothing goes on with: of other settings, or damaged
};

/// Looks at the files in the folder of the image's parts and at the checkpoints beside it. A task that would refuse one
/// would do so for ever, and a merge would take other pixels or another exposure from its parts. `wanted` is asked for
/// only if there are some: it reads all inputs of the scene.
[[nodiscard]] FarmLeftovers find_leftovers(const FarmImage& image, const std::filesystem::path& output,
                                           const std::function<WantedImage()>& wanted);

}  // namespace etendue
