// From a SceneDesc to a World: the one place where description and physics meet.
#pragma once

#include "color/color_config.h"
#include "core/error.h"
#include "core/parallel.h"
#include "scene/scene_desc.h"
#include "world/world.h"

#include <cstdint>

namespace etendue {

/// Compiles `scene`, which must have passed `validate`. Colours are converted to `working_space` (a canonical name of
/// `colors`, scene-linear). Bulk arrays are moved out of `scene`, not copied. Images are decoded and BVHs built with
/// `threads`. Warnings go to `problems`; throws SceneError for what cannot be rendered (an image that cannot be
/// decoded, no camera) and IoError when Embree fails.
[[nodiscard]] World compile_world(SceneDesc scene, const ColorConfig& colors, const std::string& working_space,
                                  const ThreadPool& threads, ProblemList& problems);

/// Memory for decoded textures, bytes, of a scene that does not say: half of the machine's.
[[nodiscard]] std::uint64_t default_texture_memory();

/// True if the textures of `scene` will be held in memory, decoded, and not in a cache: if all of them fit into what
/// its settings allow. Both give slightly different values. Reads the headers of its images; throws SceneError if it
/// cannot.
[[nodiscard]] bool holds_textures_in_memory(const SceneDesc& scene);

}  // namespace etendue
