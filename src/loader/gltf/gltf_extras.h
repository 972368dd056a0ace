// What extras (Blender's custom properties) say under the name "etendue": settings of render.json for one thing.
#pragma once

#include "loader/gltf/gltf_document.h"
#include "scene/scene_desc.h"

#include <nlohmann/json_fwd.hpp>

namespace etendue {

/// Stores in `result` the settings in the extras of the scenes, materials, nodes, cameras and lights of the checked
/// `document`. `problems` gets a warning for each other kind of object, such as meshes, whose extras have settings.
void take_extras(const nlohmann::json& document, GltfDocument& result, ProblemList& problems);

/// Finds what of the loaded `scene` the document's extras are about, and leaves out what is not shown.
void read_extras(const GltfDocument& document, SceneDesc& scene);

}  // namespace etendue
