// Triangles and shapes as the World keeps them: what Embree reads and shading interpolates.
#pragma once

#include "core/vec.h"
#include "scene/mesh_desc.h"
#include "shape/shape.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace etendue {

/// One primitive of a mesh, or of a copy of one. What is placed once and stays there is baked to world space, others
/// stay in mesh space. Attributes are empty or one per vertex. 12 bytes a triangle, 12 to 76 bytes a vertex; 24 more
/// for each step of motion.
struct Geometry {
    std::vector<Vec3f> positions;
    std::vector<Vec3f> normals;
    std::vector<Vec4f> tangents;
    std::vector<Vec2f> uv0;
    std::vector<Vec2f> uv1;
    std::vector<Vec4f> colors;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<VertexStep> motion;  ///< empty, or the vertices at equally spaced times of the shutter
    std::uint32_t material = 0;
    std::optional<ExactShape> shape;  ///< in place of triangles; `positions` are then corners of a box around it

    /// Returns whether there is no surface.
    [[nodiscard]] bool is_empty() const { return triangles.empty() && !shape; }
};

inline constexpr std::uint32_t kNone = 0xffffffffu;

/// A mesh in the world.
struct Instance {
    std::uint32_t first_geometry = 0;
    std::uint32_t geometry_count = 0;
    /// Where this instance's entries begin in the World's table of lights, one per geometry.
    std::uint32_t first_light_slot = 0;
    std::uint32_t motion = kNone;  ///< index into WorldData::motions; kNone if it stays where it is
    bool baked = true;             ///< geometry is in world space already; the matrices are identities
    bool mirrors = false;          ///< to_world turns right-handed into left-handed
    Mat4f to_world;                ///< in the middle of the shutter
    Mat4f to_local;
};

}  // namespace etendue
