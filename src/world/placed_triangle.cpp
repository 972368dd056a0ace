#include "world/placed_triangle.h"

#include "world/contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace etendue {

namespace {

/// Returns the part of a convex polygon on the side of `edge_normal` of a point.
void clip(std::vector<Vec3d>& polygon, const Vec3d& on_edge, const Vec3d& edge_normal) {
    std::vector<Vec3d> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec3d& here = polygon[i];
        const Vec3d& next = polygon[(i + 1) % polygon.size()];
        const double d0 = edge_normal.dot(here - on_edge);
        const double d1 = edge_normal.dot(next - on_edge);
        if (d0 >= 0.0) kept.push_back(here);
        if ((d0 > 0.0 && d1 < 0.0) || (d0 < 0.0 && d1 > 0.0)) kept.push_back(here + (next - here) * (d0 / (d0 - d1)));
    }
    polygon = std::move(kept);
}

}  // namespace

PlacedTriangle disk_triangle(const Geometry& geometry, const Instance& instance) {
    const ExactShape disk = instance.baked ? *geometry.shape : geometry.shape->placed(instance.to_world);
    PlacedTriangle around;
    for (std::size_t i = 0; i < 3; ++i) {
        const float turn = 2.0f / 3.0f * kPi * static_cast<float>(i);
        around.p[i] = Vec3d(disk.point({0, {2.0f * std::cos(turn), 2.0f * std::sin(turn)}}).position);
    }
    around.area = 0.5 * (around.p[1] - around.p[0]).cross(around.p[2] - around.p[0]).length();
    around.normal = Vec3d(disk.point({}).normal);
    return around;
}

PlacedTriangle place(const WorldData& data, std::uint32_t instance_index, std::uint32_t geometry_index,
                     std::uint32_t triangle_index) {
    const Instance& instance = data.instances[instance_index];
    const Geometry& geometry = data.geometries[geometry_index];
    PlacedTriangle placed;
    if (geometry.shape) {
        placed = disk_triangle(geometry, instance);
    } else {
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3f& p = geometry.positions[geometry.triangles[triangle_index][i]];
            placed.p[i] = Vec3d(instance.baked ? p : transform_point(instance.to_world, p));
        }
        const Vec3d across = (placed.p[1] - placed.p[0]).cross(placed.p[2] - placed.p[0]);
        placed.area = 0.5 * across.length();
        if (placed.is_degenerate()) return placed;
        placed.normal = across / (2.0 * placed.area) * (instance.mirrors ? -1.0 : 1.0);
    }
    const TrianglePlane plane = triangle_plane(data, instance_index, geometry_index, triangle_index);
    placed.clearance = static_cast<double>(plane.clearance);
    placed.rounding = static_cast<double>(plane.rounding);
    return placed;
}

std::optional<Bounds> touch(const PlacedTriangle& a, const PlacedTriangle& b, double distance) {
    constexpr double kParallel = 0.9;
    constexpr double kLeastShare = 1e-4;  // of the smaller one: neighbours in a mesh share an edge
    if (std::abs(a.normal.dot(b.normal)) < kParallel) return std::nullopt;
    std::vector<Vec3d> common(b.p.begin(), b.p.end());
    for (std::size_t i = 0; i < 3 && !common.empty(); ++i) {
        const Vec3d edge = a.p[(i + 1) % 3] - a.p[i];
        Vec3d inwards = a.normal.cross(edge);
        if (inwards.dot(a.p[(i + 2) % 3] - a.p[i]) < 0.0) inwards = -inwards;
        clip(common, a.p[i], inwards);
    }
    Vec3d across(0.0);
    for (std::size_t i = 2; i < common.size(); ++i) across += (common[i - 1] - common[0]).cross(common[i] - common[0]);
    if (!(0.5 * std::abs(across.dot(a.normal)) > kLeastShare * std::min(a.area, b.area))) return std::nullopt;
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    for (const Vec3d& p : common) {
        const double height = a.normal.dot(p - a.p[0]);
        least = std::min(least, height);
        most = std::max(most, height);
    }
    if (least > distance || most < -distance) return std::nullopt;
    // A little larger, as hits are only found nearly there.
    Bounds place;
    const Vec3f margin(static_cast<float>(4.0 * distance));
    for (const Vec3d& p : common) {
        place.extend(Vec3f(p) - margin);
        place.extend(Vec3f(p) + margin);
    }
    return place;
}

}  // namespace etendue
