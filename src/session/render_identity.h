// What the sums of a render depend on, so that only what belongs together is gone on with or merged.
#pragma once

#include "output/statistics.h"
#include "render/checkpoint.h"
#include "scene/scene_desc.h"

#include <span>
#include <string>

namespace etendue {

/// The part of it that `settings` decide.
[[nodiscard]] RenderIdentity settings_identity(const RenderSettings& settings);

/// Describes `scene` as it will be rendered in `working_space`: the program's version and build, the instruction set
/// that runs, the content of every input file, and each setting that the sums depend on, exactly and under the name
/// that render.json has for it. How many samples are to be taken, of which pixels, for how long, on how many threads
/// and how the image is shown is left out: a render can go on with other ones; so is where the scene lies. `inputs` are
/// those of `scene`, with their content. Throws SceneError if an image cannot be decoded.
[[nodiscard]] RenderIdentity render_identity(const SceneDesc& scene, std::span<const InputFile> inputs,
                                             const std::string& working_space);

}  // namespace etendue
