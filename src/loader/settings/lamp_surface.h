// Lamps with a surface: rectangles, disks and spheres that shine, as meshes with a black or a clear material that
// emits.
#pragma once

#include "scene/scene_desc.h"

#include <cstdint>
#include <string>

namespace etendue {

enum class LampShape { Rectangle, Disk, Sphere };

/// A lamp that shines from a surface, along its local -Z if that is flat.
struct SurfaceLamp {
    LampShape shape = LampShape::Rectangle;
    std::string name;                      ///< of its instance
    std::string data_name;                 ///< of its mesh and its material
    std::uint32_t node = NodeDesc::kNone;  ///< index into SceneDesc::nodes
    Mat4f to_world{};       ///< of a rectangle of a metre by a metre, or of a disk or sphere of radius 1 m
    Rgb color{1.0f};        ///< linear Rec.709
    float radiance = 0.0f;  ///< W/(m² sr), of a spot's beam that along the normal
    BeamDesc beam{};
    bool visible_to_camera = true;
    bool stops_light = true;  ///< of others; what goes on through it takes up its light on the way
    SourceLocation location;
};

/// Returns the area, m², of the surface of a lamp of this shape once `to_world` has placed it.
///
/// Disks are polygons of 64 corners, spheres polyhedra of 1280 facets, both with the area of what they stand for.
[[nodiscard]] double lamp_area(LampShape shape, const Mat4f& to_world);

/// Adds the mesh, the material and the instance of `lamp`.
void add_surface_lamp(const SurfaceLamp& lamp, SceneDesc& scene);

}  // namespace etendue
