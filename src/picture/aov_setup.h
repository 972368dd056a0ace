// From the layers that settings ask for to what integrators keep and files hold.
#pragma once

#include "core/error.h"
#include "output/aov_output.h"
#include "scene/scene_desc.h"
#include "wave/aov/aov_set.h"

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

/// The layers of a render.
struct AovPlan {
    std::shared_ptr<const AovSet> set;  ///< null if there are none
    std::vector<AovOutput> outputs;
    bool has_halves = false;  ///< every layer, and the image, is written of half of the samples, too: for denoising
};

/// Plans the layers that `scene.settings.aovs` ask for, with the members of each group in place of the group's name;
/// notes names that nothing in the scene has in `problems`, and throws SceneError for sources that do not exist,
/// expressions that are wrong, names that are there twice, what the integrator cannot tell apart, and layers in an ACES
/// container.
[[nodiscard]] AovPlan make_aov_plan(const SceneDesc& scene, ProblemList& problems);

/// Name of the layer that is the image of half of the samples.
inline constexpr std::string_view kHalf = "half";
/// True if that layer has a layer of half of the samples, too: mattes and depths are nothing to denoise.
[[nodiscard]] bool has_half(const AovOutput& output);
/// Name of that.
[[nodiscard]] std::string half_name(const AovOutput& output);

/// Names of the layers that have files of their own: depths always do, the others if they are all to have some
/// (`each_has_file`).
[[nodiscard]] std::vector<std::string> layers_with_files(const AovPlan& plan, bool each_has_file);

}  // namespace etendue
