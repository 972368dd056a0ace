// glTF meshes to MeshDesc.
#pragma once

#include "loader/gltf/gltf_accessor.h"
#include "loader/gltf/gltf_deformation.h"
#include "loader/gltf/gltf_document.h"
#include "scene/scene_desc.h"

#include <vector>

namespace etendue {

/// Appends one MeshDesc per glTF mesh, in their order, so that indices stay the same; a mesh of which nothing can be
/// rendered has no primitives. Materials must have been read. Primitives without one share a default material that is
/// appended when first needed. Repairs and errors go to `problems`. Returns what deforms each mesh.
[[nodiscard]] std::vector<MeshDeformation> read_meshes(const GltfDocument& document, AccessorReader& accessors,
                                                       SceneDesc& scene, ProblemList& problems);

}  // namespace etendue
