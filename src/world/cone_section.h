// Where the cone around a ray meets a surface: what is seen of its textures, and how the cone is bent there.
#pragma once

#include "core/vec.h"
#include "world/geometry.h"
#include "world/surface_point.h"

namespace etendue {

struct Hit;

/// Where a ray's cone meets a surface. Without width it is a point, and textures are read unfiltered.
struct ConeSection {
    Vec3f direction{0.0f};  ///< unit, of the ray
    float width = 0.0f;     ///< diameter across the ray, metres, >= 0
};

/// Fills in the footprints of `point`, whose position, triangle and normals are known, for a section with a width.
/// `edge1` and `edge2` are the triangle's, from its first vertex, where the ray met it, world space.
void add_footprints(const Geometry& geometry, const Vec3f& edge1, const Vec3f& edge2, const ConeSection& section,
                    SurfacePoint& point);

/// Mean curvature of the surface around the triangle at `hit`, 1/m: how fast the normals of its vertices turn away from
/// each other, positive where the front is convex. 0 without normals.
[[nodiscard]] float mean_curvature(const WorldData& data, const Hit& hit);

}  // namespace etendue
