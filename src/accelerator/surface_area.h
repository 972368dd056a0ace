// The surface area heuristic, by which trees are built.
//
// Of the rays that go through a box, as many go through a convex part of it as the part's surface is of the box's
// (Goldsmith and Salmon, "Automatic Creation of Object Hierarchies for Ray Tracing", 1987; MacDonald and Booth,
// "Heuristics for Ray Tracing Using Space Subdivision", 1990). So the work that a ray is expected to have below a node
// is the time of a step, and of each child its triangles' tests times the share of its surface.
#pragma once

#include "core/bounds.h"

namespace etendue {

/// Holds the time to go through a node and look at its children, in units of a triangle's test.
inline constexpr double kStepCost = 1.0;

/// Returns half of the surface of `box`, m²; 0 if it is empty.
[[nodiscard]] inline double half_area(const Bounds& box) {
    if (box.empty()) return 0.0;
    const Vec3d size = Vec3d(box.max) - Vec3d(box.min);
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

}  // namespace etendue
