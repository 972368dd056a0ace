#include "accelerator/clip.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace etendue {

namespace {

/// Holds the corners of a triangle that is being cut: each of six planes adds one at most.
struct Polygon {
    std::array<Vec3d, 9> corners;
    std::size_t count = 0;
};

/// Returns the part of `polygon` whose coordinate on `axis`, times `sign`, is at most `most` (Sutherland and Hodgman,
/// "Reentrant Polygon Clipping", 1974).
Polygon cut(const Polygon& polygon, int axis, double sign, double most) {
    Polygon rest;
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const Vec3d& from = polygon.corners[i];
        const Vec3d& to = polygon.corners[(i + 1) % polygon.count];
        const double beyond_from = sign * from[axis] - most;
        const double beyond_to = sign * to[axis] - most;
        if (beyond_from <= 0.0) rest.corners[rest.count++] = from;
        if ((beyond_from < 0.0 && beyond_to > 0.0) || (beyond_from > 0.0 && beyond_to < 0.0)) {
            Vec3d crossing = from + (to - from) * (beyond_from / (beyond_from - beyond_to));
            crossing[axis] = sign * most;
            rest.corners[rest.count++] = crossing;
        }
    }
    return rest;
}

float rounded_down(double value) {
    const auto near = static_cast<float>(value);
    return static_cast<double>(near) <= value ? near : std::nextafter(near, -std::numeric_limits<float>::infinity());
}

}  // namespace

std::optional<Bounds> clipped_bounds(const Triangle& triangle, const Vec3d& low, const Vec3d& high) {
    Polygon polygon{{Vec3d(triangle.a), Vec3d(triangle.b), Vec3d(triangle.c)}, 3};
    for (int axis = 0; axis < 3; ++axis) {
        polygon = cut(polygon, axis, -1.0, -low[axis]);
        polygon = cut(polygon, axis, 1.0, high[axis]);
    }
    if (polygon.count == 0) return std::nullopt;
    Bounds bounds;
    for (std::size_t i = 0; i < polygon.count; ++i)
        for (int axis = 0; axis < 3; ++axis) {
            bounds.min[axis] = std::min(bounds.min[axis], rounded_down(polygon.corners[i][axis]));
            bounds.max[axis] = std::max(bounds.max[axis], -rounded_down(-polygon.corners[i][axis]));
        }
    return bounds;
}

}  // namespace etendue
