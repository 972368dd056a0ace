// Which shape a node's mesh has: as it is, or a copy of it that is morphed and skinned.
#pragma once

#include "loader/gltf/gltf_accessor.h"
#include "loader/gltf/gltf_deformation.h"
#include "loader/gltf/gltf_posed_nodes.h"
#include "scene/scene_desc.h"

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

namespace etendue {

/// Is about how many bytes a mesh takes besides its vertices and its place: its description, and its scene in Embree.
inline constexpr std::uint64_t kBytesOfMesh = 1024;

class MeshDeformer {
  public:
    MeshDeformer(const GltfDocument& document, AccessorReader& accessors, std::span<const MeshDeformation> deformations,
                 const PosedNodes& nodes, SceneDesc& scene, ProblemList& problems)
        : document_(document),
          accessors_(accessors),
          deformations_(deformations),
          nodes_(nodes),
          scene_(scene),
          problems_(problems) {}

    struct Result {
        Handle<MeshDesc> mesh;
        bool is_in_world_space = false;  ///< a skin has placed it; the node's own transform does not count
    };

    /// The mesh of a placed node that has one, in its pose, with its motion while the shutter is open. A mesh that
    /// cannot be deformed stays as it is, with an error.
    [[nodiscard]] Result deform(int node, const SourceLocation& where);

  private:
    /// A skin's joints, all of them in the scene.
    struct Binding {
        std::span<const int> joints;      ///< nodes
        std::vector<Mat4d> inverse_bind;  ///< from the mesh to each joint
        std::vector<Mat4d> to_world;      ///< from the mesh to the world by way of each joint
        bool moves = false;               ///< a joint moves while the shutter is open
    };

    /// Returns the binding of the skin of this glTF index, made once however many nodes have it.
    [[nodiscard]] const std::optional<Binding>& binding_of(int skin, const SourceLocation& where);
    /// Nothing, with an error, if the skin cannot be had.
    [[nodiscard]] std::optional<Binding> bind(const GltfSkin& skin, const SourceLocation& where);
    [[nodiscard]] const std::vector<double>& weights_of(int node, const std::vector<double>& animated) const;
    /// The vertices of `primitive` through the time that the shutter is open; empty if that is more than may be
    /// decoded.
    [[nodiscard]] std::vector<VertexStep> move(const PrimitiveDesc& primitive, const PrimitiveDeformation& deformation,
                                               int node, const std::optional<Binding>& binding,
                                               const SourceLocation& where);
    /// False if copies of the mesh are more than may be decoded.
    [[nodiscard]] bool allocate_copy(const MeshDesc& mesh, const SourceLocation& where);

    const GltfDocument& document_;
    AccessorReader& accessors_;
    std::span<const MeshDeformation> deformations_;
    const PosedNodes& nodes_;
    SceneDesc& scene_;
    ProblemList& problems_;
    std::map<int, std::optional<Binding>> bindings_;  ///< by the skin's glTF index
};

}  // namespace etendue
