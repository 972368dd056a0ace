// A point of a triangle: what a surface is there before its material says anything.
#pragma once

#include "core/frame.h"
#include "core/lane.h"
#include "core/position_error.h"

namespace etendue {

/// A template of its lane type, see core/lane.h.
template <typename T>
struct TrianglePoint {
    Imath::Vec3<T> position;  ///< in the space of the vertices
    Imath::Vec3<T> normal;    ///< unit, of the triangle
    Imath::Vec3<T> extent;    ///< largest coordinates of the vertices, absolute

    /// `barycentric` are the weights of the vertices at the ends of the edges, which begin at `p0`.
    TrianglePoint(const Imath::Vec3<T>& p0, const Imath::Vec3<T>& edge1, const Imath::Vec3<T>& edge2,
                  const Imath::Vec2<T>& barycentric)
        : position(p0 + edge1 * barycentric.x + edge2 * barycentric.y),
          normal(triangle_normal(edge1, edge2)),
          extent(max_components(abs_components(p0),
                                max_components(abs_components(p0 + edge1), abs_components(p0 + edge2)))) {}
};

/// The interpolated normal `shading` with length 1; `geometric` where it cannot be used, since interpolated normals can
/// cancel out or point to the back. A template of its lane type, see core/lane.h.
template <typename T>
[[nodiscard]] inline Imath::Vec3<T> usable_normal(const Imath::Vec3<T>& shading, const Imath::Vec3<T>& geometric) {
    const T shading_length = length(shading);
    const auto usable = shading_length > T(0.0f) && dot(shading, geometric) > T(0.0f);
    const T scale = 1.0f / shading_length;
    return {select(usable, shading.x * scale, geometric.x), select(usable, shading.y * scale, geometric.y),
            select(usable, shading.z * scale, geometric.z)};
}

}  // namespace etendue
