// What the surfaces of a scene are called in Cryptomattes.
#pragma once

#include "scene/scene_desc.h"

#include <string>
#include <string_view>
#include <vector>

namespace etendue {

/// `name` without what programs that read manifests stumble over: control characters become '_', and what is longer
/// than 255 bytes is cut between two characters.
[[nodiscard]] std::string clean_matte_name(std::string_view name);

/// Returns for each instance the name of its node: nodes that share a name are called by the names from the top of the
/// scene down to them, "car/wheel", 32 at most, each of which is cut for itself; where such a name is taken, too, '#'
/// and the number of the node in the file, or the next number that is free, stands behind the name; instances of one
/// node (EXT_mesh_gpu_instancing) are one object, and nodes without a name are "unnamed_node_N" unless their mesh has a
/// name.
[[nodiscard]] std::vector<std::string> object_names(const SceneDesc& scene);

/// Returns for each instance the name of its topmost node or, if that node has no name, of the mesh at the node, or
/// else "unnamed_node_N"; instances with equal names are one asset.
[[nodiscard]] std::vector<std::string> asset_names(const SceneDesc& scene);

/// Returns the name of each material, "unnamed_material_N" for one without a name and "default_material" for the one of
/// primitives without a material; materials with equal names are one in mattes.
[[nodiscard]] std::vector<std::string> material_names(const SceneDesc& scene);

}  // namespace etendue
