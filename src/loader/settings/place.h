// Where render.json puts a thing of its own: a lamp or a shape.
#pragma once

#include "core/vec.h"
#include "loader/settings/json_object.h"

#include <array>
#include <optional>
#include <string>

namespace etendue {

/// Says where a thing of render.json is; nowhere, if it has neither a node nor a position.
struct Place {
    std::string node;  ///< name of the node that places it; empty for none
    std::optional<Vec3d> position;
    std::array<double, 4> rotation{0.0, 0.0, 0.0, 1.0};  ///< quaternion x, y, z, w
    std::optional<Vec3d> look_at;                        ///< in place of the rotation
    Vec3f up{0.0f, 1.0f, 0.0f};                          ///< not parallel to where it looks
};

/// Reads the members of `object` that place it, with errors for what contradicts itself.
void read_place(JsonObject& object, Place& place);

/// Returns the transform of a place with a position, for a scene with this origin.
[[nodiscard]] Mat4f placed(const Place& place, const Vec3d& origin);

}  // namespace etendue
