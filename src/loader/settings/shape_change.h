// What render.json says of exact shapes: in place of meshes of the scene file, or at places of their own.
#pragma once

#include "core/error.h"
#include "loader/settings/place.h"
#include "scene/scene_desc.h"

#include <map>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace etendue {

struct ShapeChange {
    ShapeDesc shape;
    Place place;
    std::string material;  ///< name; empty for that of the mesh whose place it takes
    SourceLocation location;
};

/// Reads one member of `shapes`.
[[nodiscard]] ShapeChange read_shape(const nlohmann::json& value, const SourceLocation& where, ProblemList& problems);

/// Puts the shapes in place of the meshes of their nodes, or adds them. Errors for names that the scene does not have,
/// and for shapes without a material.
void apply_shapes(const std::map<std::string, ShapeChange>& changes, SceneDesc& scene, ProblemList& problems);

}  // namespace etendue
