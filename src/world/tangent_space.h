// Tangent frames for meshes that have none, as MikkTSpace defines them (Mikkelsen, "Simulation of Wrinkled Surfaces
// Revisited", 2008, section 2.3; glTF 2.0, section 3.7.2.1): normal maps baked for them look right.
//
// Triangles around a vertex share a frame as long as they are connected by edges, with equal positions, normals and
// texture coordinates, and their texture is mirrored in all of them or in none. Frames are means weighted by angles.
// Triangles without an area in the texture or in space take the frame of a neighbour. The smoothing angle is the
// format's 180 degrees: frames are never divided by it.
#pragma once

#include "core/vec.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// A mesh whose vertices have one tangent each. Vertices in which frames meet are divided: the first ones are those of
/// the mesh, in their order, and copies come after them.
struct TangentVertices {
    /// xyz unit length, perpendicular to the normal, along increasing u; w = ±1, so that cross(normal, xyz) * w is the
    /// direction of decreasing v, which is up in glTF's images.
    std::vector<Vec4f> tangents;
    std::vector<std::uint32_t> source;  ///< the vertex of the mesh that each one is a copy of
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Tangents of a mesh with unit `normals` and texture coordinates `uv`, one per vertex; indices must be in range.
[[nodiscard]] TangentVertices generate_tangents(std::span<const Vec3f> positions, std::span<const Vec3f> normals,
                                                std::span<const Vec2f> uv,
                                                std::span<const std::array<std::uint32_t, 3>> triangles);

}  // namespace etendue
