// What extras (Blender's custom properties) say under the name "etendue": settings of render.json for one thing.
#pragma once

#include "loader/gltf/gltf_document.h"
#include "scene/scene_desc.h"

#include <nlohmann/json_fwd.hpp>

namespace etendue {

/// Notes in `result` all that the extras of the checked `document` say of its scenes, materials, nodes, cameras and
/// lights; `problems` gets a warning for each other kind of thing of which they say something.
void take_extras(const nlohmann::json& document, GltfDocument& result, ProblemList& problems);

/// Finds what of the loaded `scene` the document's extras are about, and leaves out what is not shown.
void read_extras(const GltfDocument& document, SceneDesc& scene);

}  // namespace etendue
