// Lamps with a surface: rectangles, disks and spheres that shine, as exact shapes with a black or a clear material that
// emits.
#pragma once

#include "scene/scene_desc.h"

#include <cstdint>
#include <string>

namespace etendue {

/// A lamp that shines from a surface, along its local -Z if that is flat.
struct SurfaceLamp {
    ShapeDesc shape;
    std::string name;                      ///< name of its instance
    std::string data_name;                 ///< name of its mesh and its material
    std::uint32_t node = NodeDesc::kNone;  ///< index into SceneDesc::nodes
    Mat4f to_world{};                      ///< in the middle of the shutter
    TransformMotion motion;                ///< `to_world` while the shutter is open; empty if the lamp stands still
    Rgb color{1.0f};                       ///< linear Rec.709
    float radiance = 0.0f;                 ///< W/(m² sr); for a spot's beam, along the normal
    BeamDesc beam{};
    bool visible_to_camera = true;
    /// Tells whether it stops other lamps' light; rays that go on through it take up its light on the way.
    bool stops_light = true;
    SourceLocation location;
};

/// Adds the shape, the material and the instance of `lamp`.
void add_surface_lamp(const SurfaceLamp& lamp, SceneDesc& scene);

}  // namespace etendue
