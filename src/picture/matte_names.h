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

/// Of each instance: the name of its node. Nodes that share a name are called by the names from the top of the scene
/// down to them, "car/wheel", 32 at most, each of which is cut for itself; where that is taken, too, '#' and the number
/// of the node in the file stands behind it, or the next that is free. Instances of one node (EXT_mesh_gpu_instancing)
/// are one object. Nodes without a name are "unnamed_node_N" unless their mesh has one.
[[nodiscard]] std::vector<std::string> object_names(const SceneDesc& scene);

/// Of each instance: the name of its topmost node; if that has none, that of the mesh at this node, or else
/// "unnamed_node_N"; of equal ones, one.
[[nodiscard]] std::vector<std::string> asset_names(const SceneDesc& scene);

/// Of each material: its name, "unnamed_material_N" if it has none, "default_material" if it is that of primitives
/// without one; of equal ones, one.
[[nodiscard]] std::vector<std::string> material_names(const SceneDesc& scene);

}  // namespace etendue
