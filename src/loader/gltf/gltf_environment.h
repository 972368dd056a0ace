// EXT_lights_image_based: the environment of a scene as a cube map.
#pragma once

#include "loader/gltf/gltf_document.h"
#include "loader/gltf/gltf_textures.h"
#include "scene/scene_desc.h"

namespace etendue {

/// Sets the environment of `scene` to the image-based light of the scene that it shows, if that has one: the sharpest
/// level of its cube map. The blurred levels and the irradiance coefficients are what a rasteriser needs in place of
/// integrating, and are not used.
void read_environment(const GltfDocument& document, TextureReader& textures, SceneDesc& scene, ProblemList& problems);

}  // namespace etendue
