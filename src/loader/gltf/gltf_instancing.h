// EXT_mesh_gpu_instancing: one node that places its mesh many times.
#pragma once

#include "loader/gltf/gltf_accessor.h"
#include "loader/gltf/gltf_transform.h"

#include <optional>
#include <vector>

namespace etendue {

/// The transforms from the mesh to the node, one for each instance, as the attributes TRANSLATION, ROTATION and SCALE
/// say; others are for shaders. Nothing, and an error at `where`, if they cannot be read or differ in length.
[[nodiscard]] std::optional<std::vector<Mat4d>> read_instance_transforms(const tinygltf::Value& extension,
                                                                         AccessorReader& accessors,
                                                                         const SourceLocation& where,
                                                                         ProblemList& problems);

}  // namespace etendue
