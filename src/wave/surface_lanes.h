// Points on plain surfaces (world/plain_surface.h) for a block of paths.
#pragma once

#include "core/columns.h"
#include "world/world.h"

#include <cstddef>

namespace etendue {

struct SurfaceLanes {
    /// Hold the triangle that was hit, as in HitTriangle.
    Vec3Columns p0, edge1, edge2;
    Vec3Columns triangle_normal;
    Vec2Columns u;  ///< barycentric coordinates of the hit

    // The surface, as in SurfacePoint.
    Vec3Columns position, geometric_normal;
    Column clearance;
    Vec3Columns tangent, bitangent, normal;

    /// Sets what `set_up_points` needs of the path in `lane`.
    void set_hit(std::size_t lane, const HitTriangle& triangle, Vec2f barycentric) {
        p0.set(lane, triangle.p0);
        edge1.set(lane, triangle.edge1);
        edge2.set(lane, triangle.edge2);
        triangle_normal.set(lane, triangle.shading_normal);
        u.set(lane, barycentric);
    }
    /// Computes the points of lanes [0, count), rounded up.
    void set_up_points(std::size_t count);
};

}  // namespace etendue
