// A triangle where it is in the scene, and whether another touches it.
#pragma once

#include "core/bounds.h"
#include "core/vec.h"
#include "world/world_data.h"

#include <array>
#include <cstdint>
#include <optional>

namespace etendue {

/// Returns a triangle of an instance in world space, in the middle of the shutter.
struct PlacedTriangle {
    std::array<Vec3d, 3> p;
    Vec3d normal;  ///< unit, on the front
    double area = 0.0;
    double clearance = 0.0;  ///< metres, as in TrianglePlane
    double rounding = 0.0;   ///< metres, as in TrianglePlane

    [[nodiscard]] bool is_degenerate() const { return !(area > 0.0); }
};

/// Returns the triangle around a disk whose sides touch it.
[[nodiscard]] PlacedTriangle disk_triangle(const Geometry& geometry, const Instance& instance);

/// Places a triangle; of a disk, the one around it whose sides touch it.
[[nodiscard]] PlacedTriangle place(const WorldData& data, std::uint32_t instance, std::uint32_t geometry,
                                   std::uint32_t triangle);

/// Returns where the triangles, seen along the normal of the first, overlap by more than rounding, if they come within
/// `distance` of each other there.
[[nodiscard]] std::optional<Bounds> touch(const PlacedTriangle& a, const PlacedTriangle& b, double distance);

}  // namespace etendue
