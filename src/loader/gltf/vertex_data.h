// Making a primitive's vertices fit for rendering: triangles from strips and fans, sound normals, no dead weight.
#pragma once

#include "core/vec.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

using Triangle = std::array<std::uint32_t, 3>;

enum class TriangleMode { List = 4, Strip = 5, Fan = 6 };

/// The triangles of a primitive with these indices, wound as the specification says (3.7.2.1). Indices that make no
/// whole triangle are dropped.
[[nodiscard]] std::vector<Triangle> assemble_triangles(std::span<const std::uint32_t> indices, TriangleMode mode);

/// Returns whether a triangle has no area: two equal vertices, or a height below 1e-9 of the longest side. Indices must
/// be in range.
[[nodiscard]] bool is_degenerate(const Triangle& triangle, std::span<const Vec3f> positions);

/// Removes the triangles that `is_degenerate`; returns how many were removed.
std::size_t remove_degenerate_triangles(std::vector<Triangle>& triangles, std::span<const Vec3f> positions);

/// Renumbers `triangles` so that every vertex is used, and returns the old number of each new vertex, ascending.
[[nodiscard]] std::vector<std::uint32_t> compact_vertices(std::vector<Triangle>& triangles, std::size_t vertex_count);

/// Unit normals per vertex: the sum of the normals of the triangles around it, weighted by their areas. Where they
/// cancel out, the normal of one of these triangles. Triangles must not be degenerate and must use every vertex.
[[nodiscard]] std::vector<Vec3f> area_weighted_normals(std::span<const Triangle> triangles,
                                                       std::span<const Vec3f> positions);

/// Makes `normals` unit length; those that are zero or not finite become `area_weighted_normals`. Returns how many
/// were.
std::size_t normalize_normals(std::vector<Vec3f>& normals, std::span<const Triangle> triangles,
                              std::span<const Vec3f> positions);

/// Makes the vectors of `tangents` unit length and their signs 1 or -1. False if one is zero or not finite.
[[nodiscard]] bool normalize_tangents(std::vector<Vec4f>& tangents);

}  // namespace etendue
