// The node hierarchy to instances, cameras and lights in world space.
#pragma once

#include "loader/gltf/gltf_accessor.h"
#include "loader/gltf/gltf_animation.h"
#include "loader/gltf/gltf_deformation.h"
#include "loader/gltf/gltf_document.h"
#include "scene/scene_desc.h"
#include "scene/swept_space.h"

#include <span>

namespace etendue {

/// Appends what the nodes of the document's scene place: `scene`, else the first one, else all root nodes. The meshes
/// must have been read. Errors if the nodes are no forest (a cycle, or a node with two parents) or a transform is not
/// affine; nodes with a singular transform are left out with a warning.
/// `deformations` are those of the meshes. The nodes are where `animation` has them at the moment that `settings` show,
/// or in their own pose without one; skinned and morphed meshes are appended to the scene's as they are then. All that
/// moves while the shutter is open gets its motion.
void read_nodes(const GltfDocument& document, AccessorReader& accessors, std::span<const MeshDeformation> deformations,
                const AnimationSampler* animation, const RenderSettings& settings, SceneDesc& scene,
                ProblemList& problems);

/// Returns the room that what `read_nodes` has placed in `scene` takes in the course of `animation`, at moments spread
/// over it; nothing if that cannot be found out. Leaves `scene` as it is.
[[nodiscard]] SweptSpace swept_by_animation(const GltfDocument& document, std::span<const MeshDeformation> deformations,
                                            const AnimationSampler& animation, const RenderSettings& settings,
                                            SceneDesc& scene);

}  // namespace etendue
