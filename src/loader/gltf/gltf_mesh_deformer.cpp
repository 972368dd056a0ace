#include "loader/gltf/gltf_mesh_deformer.h"

#include <algorithm>

#include <fmt/format.h>

namespace etendue {

MeshDeformer::Result MeshDeformer::deform(const tinygltf::Node& node, const NodePose& pose,
                                          const SourceLocation& where) {
    const auto index = static_cast<std::size_t>(node.mesh);
    const MeshDeformation& deformation = deformations_[index];
    const std::vector<double>& weights = !pose.weights.empty()   ? pose.weights
                                         : !node.weights.empty() ? node.weights
                                                                 : deformation.default_weights;
    const bool is_morphed =
        std::ranges::any_of(weights, [](double w) { return w != 0.0; }) &&
        std::ranges::any_of(deformation.primitives, [](const PrimitiveDeformation& p) { return !p.targets.empty(); });
    const bool is_skinned = node.skin >= 0 && deformation.is_skinned();
    const Result unchanged{{node.mesh}, false};
    if (!is_morphed && !is_skinned) return unchanged;

    std::vector<Mat4d> joints;
    if (is_skinned) {
        joints = joint_matrices(document_.skins[static_cast<std::size_t>(node.skin)], where);
        if (joints.empty()) return unchanged;
        if (deformation.largest_joint() >= joints.size()) {
            problems_.error(where, fmt::format("the mesh refers to joint {}, but the skin has {}",
                                               deformation.largest_joint(), joints.size()));
            return unchanged;
        }
    }
    // Copies are taken from what may still be decoded: any number of nodes can deform one mesh.
    for (const PrimitiveDesc& primitive : scene_.meshes[index].primitives) {
        constexpr std::size_t kBytesPerVertex = sizeof(Vec3f) * 2 + sizeof(Vec4f) * 2 + sizeof(Vec2f) * 2;
        if (!accessors_.allocate(primitive.positions.size(), kBytesPerVertex, where) ||
            !accessors_.allocate(primitive.triangles.size(), 3 * sizeof(std::uint32_t), where))
            return unchanged;
    }
    MeshDesc mesh{scene_.meshes[index].name, {}, scene_.meshes[index].location};
    for (std::size_t p = 0; p < deformation.primitives.size(); ++p) {
        PrimitiveDesc primitive = scene_.meshes[index].primitives[p];
        morph(primitive, deformation.primitives[p], weights);
        if (is_skinned) skin(primitive, deformation.primitives[p], joints);
        if (finish_deformation(primitive, deformation.primitives[p]))
            mesh.primitives.push_back(std::move(primitive));
        else
            problems_.warning(where,
                              fmt::format("primitive {} of the mesh has nothing to show once it is deformed", p));
    }
    scene_.meshes.push_back(std::move(mesh));
    return {{static_cast<std::int32_t>(scene_.meshes.size()) - 1}, is_skinned};
}

std::vector<Mat4d> MeshDeformer::joint_matrices(const GltfSkin& skin, const SourceLocation& where) {
    std::vector<Mat4d> matrices(skin.joints.size());
    if (skin.inverse_bind_matrices) {
        const std::optional<AttributeData> data = accessors_.attribute(*skin.inverse_bind_matrices, {16, 16}, where);
        if (!data) return {};
        if (data->values.size() < 16 * matrices.size()) {
            problems_.error(where, fmt::format("{} inverse bind matrices for {} joints", data->values.size() / 16,
                                               matrices.size()));
            return {};
        }
        for (std::size_t j = 0; j < matrices.size(); ++j)
            for (std::size_t i = 0; i < 16; ++i)
                matrices[j][static_cast<int>(i / 4)][static_cast<int>(i % 4)] =
                    static_cast<double>(data->values[16 * j + i]);
    }
    for (std::size_t j = 0; j < matrices.size(); ++j) {
        const std::optional<Mat4d>& joint = to_world_[static_cast<std::size_t>(skin.joints[j])];
        if (!joint) {
            problems_.error(where,
                            fmt::format("joint {} of the skin, node {}, is not in the scene", j, skin.joints[j]));
            return {};
        }
        matrices[j] = matrices[j] * *joint;
    }
    return matrices;
}

}  // namespace etendue
