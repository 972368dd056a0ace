// Meshes that change their shape: morph targets and skins.
#pragma once

#include "core/vec.h"
#include "loader/gltf/gltf_transform.h"
#include "scene/mesh_desc.h"

#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// Displacements of one morph target; each array is empty or one per vertex.
struct MorphTarget {
    std::vector<Vec3f> positions;
    std::vector<Vec3f> normals;
    std::vector<Vec3f> tangents;
};

/// Holds the morph targets and joints that deform a primitive, in the order of the primitive's vertices.
struct PrimitiveDeformation {
    std::vector<MorphTarget> targets;
    std::size_t influences = 0;         ///< joints that move a vertex
    std::vector<std::uint32_t> joints;  ///< `influences` a vertex: indices into the skin's joints
    std::vector<float> weights;         ///< weights of `joints`, >= 0
    bool has_flat_triangles = false;    ///< some triangles have no area before they are deformed

    /// Returns the largest index of a joint that moves a vertex; 0 if there is none.
    [[nodiscard]] std::uint32_t largest_joint() const;
};

/// One for each primitive of a mesh.
struct MeshDeformation {
    std::vector<double> default_weights;  ///< default weights of the morph targets
    std::vector<PrimitiveDeformation> primitives;

    [[nodiscard]] bool is_skinned() const;
    /// Returns whether triangles have no area where nothing deforms the mesh.
    [[nodiscard]] bool has_flat_triangles() const;
    /// Returns the largest index of a joint that moves a vertex; 0 if there is none.
    [[nodiscard]] std::uint32_t largest_joint() const;
};

/// Adds weighted displacements: p + sum of w_i d_i. Weights beyond the targets are ignored, missing ones are 0.
void morph(PrimitiveDesc& primitive, const PrimitiveDeformation& deformation, std::span<const double> weights);

/// Moves every vertex by the weighted mean of its joints' transforms (linear blend skinning); the result is in the
/// space that `joints` lead to. Joint indices must be in range.
void skin(PrimitiveDesc& primitive, const PrimitiveDeformation& deformation, std::span<const Mat4d> joints);

/// Makes the normals and tangents unit length again, and drops triangles that have lost their area;
/// the same vertices and triangles go from its motion. False if a position is not finite or no triangle is left.
[[nodiscard]] bool finish_deformation(PrimitiveDesc& primitive);

}  // namespace etendue
