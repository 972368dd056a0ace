// Which shape a node's mesh has: as it is, or a copy of it that is morphed and skinned.
#pragma once

#include "loader/gltf/gltf_accessor.h"
#include "loader/gltf/gltf_animation.h"
#include "loader/gltf/gltf_deformation.h"
#include "scene/scene_desc.h"

#include <optional>
#include <span>
#include <vector>

namespace etendue {

class MeshDeformer {
  public:
    /// `to_world` are the transforms of all nodes that the scene shows, by node index.
    MeshDeformer(const GltfDocument& document, AccessorReader& accessors, std::span<const MeshDeformation> deformations,
                 std::span<const std::optional<Mat4d>> to_world, SceneDesc& scene, ProblemList& problems)
        : document_(document),
          accessors_(accessors),
          deformations_(deformations),
          to_world_(to_world),
          scene_(scene),
          problems_(problems) {}

    struct Result {
        Handle<MeshDesc> mesh;
        bool is_in_world_space = false;  ///< a skin has placed it; the node's own transform does not count
    };

    /// The mesh of `node`, which has one, in `pose`. A mesh that cannot be deformed stays as it is, with an error.
    [[nodiscard]] Result deform(const tinygltf::Node& node, const NodePose& pose, const SourceLocation& where);

  private:
    /// From the mesh to the world by way of each joint; empty, with an error, if they cannot be had.
    [[nodiscard]] std::vector<Mat4d> joint_matrices(const GltfSkin& skin, const SourceLocation& where);

    const GltfDocument& document_;
    AccessorReader& accessors_;
    std::span<const MeshDeformation> deformations_;
    std::span<const std::optional<Mat4d>> to_world_;
    SceneDesc& scene_;
    ProblemList& problems_;
};

}  // namespace etendue
