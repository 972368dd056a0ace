// From a SceneDesc to a World: the one place where description and physics meet.
#pragma once

#include "color/color_config.h"
#include "core/error.h"
#include "core/parallel.h"
#include "scene/scene_desc.h"
#include "world/world.h"

#include <cstddef>
#include <cstdint>

namespace etendue {

/// How a scene is compiled. Whatever they say, what is rendered is the same but for roundings, for the chance by which
/// rays pass partly transparent surfaces and, under uneven scales, for how normals run between vertices.
struct CompileOptions {
    /// Triangles, beyond those of the meshes themselves, for copies of meshes that are placed more than once. Rays pass
    /// one BVH over everything up to several times as fast as instances in one (docs/optimisation.md); a copied
    /// triangle takes 100 to 210 bytes. What is more stays instanced.
    std::size_t most_copied_triangles = std::size_t{1} << 18;
};

/// Compiles `scene`, which must have passed `validate`. Colours are converted to `working_space` (a canonical name of
/// `colors`, scene-linear). Bulk arrays are moved out of `scene`, not copied. Images are decoded and BVHs built with
/// `threads`. Warnings go to `problems`; throws SceneError for what cannot be rendered (an image that cannot be
/// decoded, no camera) and IoError when Embree fails.
[[nodiscard]] World compile_world(SceneDesc scene, const ColorConfig& colors, const std::string& working_space,
                                  const ThreadPool& threads, ProblemList& problems, const CompileOptions& options = {});

/// Returns `world` seen by the camera that the settings of `scene` choose and place; of `scene` nothing else is looked
/// at. Surfaces, lights and what finds them stay as they are. Throws SceneError if there is no such camera.
[[nodiscard]] World with_camera(World world, const SceneDesc& scene);

/// Memory for decoded textures, bytes, of a scene that does not say: half of the machine's.
[[nodiscard]] std::uint64_t default_texture_memory();

/// True if the textures of `scene` will be held in memory, decoded, and not in a cache: if all of them fit into what
/// its settings allow. Both give slightly different values. Reads the headers of its images; throws SceneError if it
/// cannot.
[[nodiscard]] bool holds_textures_in_memory(const SceneDesc& scene);

}  // namespace etendue
