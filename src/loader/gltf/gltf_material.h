// glTF materials to MaterialDesc.
#pragma once

#include "loader/gltf/gltf_document.h"
#include "loader/gltf/gltf_textures.h"
#include "scene/scene_desc.h"

namespace etendue {

/// Appends one MaterialDesc per glTF material, in their order. Factors outside their range are moved into it with a
/// warning; textures that cannot be used are left out and reported.
void read_materials(const GltfDocument& document, TextureReader& textures, SceneDesc& scene, ProblemList& problems);

}  // namespace etendue
