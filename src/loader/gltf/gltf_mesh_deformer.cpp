#include "loader/gltf/gltf_mesh_deformer.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Most pieces of a deformation: each step is a copy of the vertices.
constexpr std::size_t kMaxDeformationSegments = 16;

/// Keeps the fewest of `steps` from which straight lines lead to all of them within a thousandth of what they sweep.
void thin_out(std::vector<VertexStep>& steps) {
    Bounds swept;
    for (const VertexStep& step : steps)
        for (const Vec3f& p : step.positions) swept.extend(p);
    const auto distance = [&](std::size_t a, std::size_t b, double t, std::size_t c) {
        float largest = 0.0f;
        for (std::size_t v = 0; v < steps[a].positions.size(); ++v) {
            const Vec3f& from = steps[a].positions[v];
            const Vec3f straight = from + (steps[b].positions[v] - from) * static_cast<float>(t);
            largest = std::max(largest, length(straight - steps[c].positions[v]));
        }
        return static_cast<double>(largest);
    };
    const double tolerance = kMotionTolerance * static_cast<double>(length(swept.size()));
    const std::size_t stride = coarsest_stride(steps.size() - 1, tolerance, distance);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < steps.size(); i += stride) std::swap(steps[kept++], steps[i]);
    steps.resize(kept);
}

/// Returns about how many steps of arithmetic it takes to pose a primitive once, besides those for each vertex.
std::uint64_t work_of(const PrimitiveDeformation& deformation, std::span<const double> weights, bool is_skinned) {
    constexpr std::uint64_t kStepsOfInfluence = 8;
    std::uint64_t steps = is_skinned ? kStepsOfInfluence * deformation.joints.size() : 0;
    for (std::size_t i = 0; i < std::min(weights.size(), deformation.targets.size()); ++i) {
        const MorphTarget& target = deformation.targets[i];
        if (static_cast<float>(weights[i]) != 0.0f)
            steps += target.positions.size() + target.normals.size() + target.tangents.size();
    }
    return steps;
}

}  // namespace

MeshDeformer::Result MeshDeformer::deform(int node_index, const SourceLocation& where) {
    const tinygltf::Node& node = document_.model.nodes[static_cast<std::size_t>(node_index)];
    const auto index = static_cast<std::size_t>(node.mesh);
    const MeshDeformation& deformation = deformations_[index];
    const std::vector<double>& weights = weights_of(node_index, nodes_.pose(node_index).weights);
    const bool weights_change = nodes_.weights_change(node_index);
    const bool is_morphed =
        (weights_change || std::ranges::any_of(weights, [](double w) { return w != 0.0; })) &&
        std::ranges::any_of(deformation.primitives, [](const PrimitiveDeformation& p) { return !p.targets.empty(); });
    const bool is_skinned = node.skin >= 0 && deformation.is_skinned();
    const Result unchanged{{node.mesh}, false};
    if (!is_morphed && !is_skinned && !deformation.has_flat_triangles()) return unchanged;

    static const std::optional<Binding> kNone;
    const std::optional<Binding>& binding = is_skinned ? binding_of(node.skin, where) : kNone;
    if (is_skinned) {
        if (!binding) return unchanged;
        if (deformation.largest_joint() >= binding->joints.size()) {
            problems_.error(where, fmt::format("the mesh refers to joint {}, but the skin has {}",
                                               deformation.largest_joint(), binding->joints.size()));
            return unchanged;
        }
    }
    if (!allocate_copy(scene_.meshes[index], where)) return unchanged;
    const bool moves = (is_morphed && weights_change) || (binding && binding->moves);

    MeshDesc mesh{scene_.meshes[index].name, {}, scene_.meshes[index].location};
    for (std::size_t p = 0; p < deformation.primitives.size(); ++p) {
        if (!accessors_.allow_work(work_of(deformation.primitives[p], weights, is_skinned), where)) return unchanged;
        PrimitiveDesc primitive = scene_.meshes[index].primitives[p];
        if (moves) primitive.motion = move(primitive, deformation.primitives[p], node_index, binding, where);
        morph(primitive, deformation.primitives[p], weights);
        if (binding) skin(primitive, deformation.primitives[p], binding->to_world);
        if (finish_deformation(primitive))
            mesh.primitives.push_back(std::move(primitive));
        else
            problems_.warning(where,
                              fmt::format("primitive {} of the mesh has nothing to show once it is deformed", p));
    }
    scene_.meshes.push_back(std::move(mesh));
    return {{static_cast<std::int32_t>(scene_.meshes.size()) - 1}, is_skinned};
}

const std::vector<double>& MeshDeformer::weights_of(int node_index, const std::vector<double>& animated) const {
    const tinygltf::Node& node = document_.model.nodes[static_cast<std::size_t>(node_index)];
    if (!animated.empty()) return animated;
    return !node.weights.empty() ? node.weights : deformations_[static_cast<std::size_t>(node.mesh)].default_weights;
}

/// Copies are taken from what may still be decoded: any number of nodes can deform one mesh.
bool MeshDeformer::allocate_copy(const MeshDesc& mesh, const SourceLocation& where) {
    constexpr std::size_t kBytesPerVertex = sizeof(Vec3f) * 2 + sizeof(Vec4f) * 2 + sizeof(Vec2f) * 2;
    return accessors_.allocate(1, kBytesOfMesh, where) &&
           std::ranges::all_of(mesh.primitives, [&](const PrimitiveDesc& primitive) {
               return accessors_.allocate(primitive.positions.size(), kBytesPerVertex, where) &&
                      accessors_.allocate(primitive.triangles.size(), 3 * sizeof(std::uint32_t), where);
           });
}

std::vector<VertexStep> MeshDeformer::move(const PrimitiveDesc& primitive, const PrimitiveDeformation& deformation,
                                           int node, const std::optional<Binding>& binding,
                                           const SourceLocation& where) {
    const std::size_t segments = std::min(nodes_.segments(), kMaxDeformationSegments);
    if (!accessors_.allocate(primitive.positions.size() * (segments + 1), 2 * sizeof(Vec3f), where)) return {};
    std::vector<VertexStep> steps(segments + 1);
    constexpr std::uint64_t kStepsOfJoint = 32;
    std::vector<Mat4d> joints(binding && deformation.influences > 0 ? deformation.largest_joint() + 1 : 0);
    for (std::size_t s = 0; s <= segments; ++s) {
        const std::size_t moment = s * (nodes_.segments() / segments);
        const std::vector<double>& weights = weights_of(node, nodes_.weights_at(node, moment));
        const std::uint64_t work = work_of(deformation, weights, binding.has_value()) + kStepsOfJoint * joints.size();
        if (!accessors_.allow_work(work, where)) return {};
        PrimitiveDesc vertices;
        vertices.positions = primitive.positions;
        vertices.normals = primitive.normals;
        morph(vertices, deformation, weights);
        for (std::size_t j = 0; j < joints.size(); ++j)
            joints[j] = binding->inverse_bind[j] * nodes_.to_world_at(binding->joints[j], moment);
        if (binding) skin(vertices, deformation, joints);
        steps[s] = {std::move(vertices.positions), std::move(vertices.normals)};
    }
    thin_out(steps);
    return steps;
}

const std::optional<MeshDeformer::Binding>& MeshDeformer::binding_of(int skin, const SourceLocation& where) {
    const auto known = bindings_.find(skin);
    if (known != bindings_.end()) return known->second;
    return bindings_[skin] = bind(document_.skins[static_cast<std::size_t>(skin)], where);
}

std::optional<MeshDeformer::Binding> MeshDeformer::bind(const GltfSkin& skin, const SourceLocation& where) {
    Binding binding{skin.joints, std::vector<Mat4d>(skin.joints.size()), {}, false};
    std::vector<Mat4d>& matrices = binding.inverse_bind;
    if (skin.inverse_bind_matrices) {
        const std::optional<AttributeData> data = accessors_.attribute(*skin.inverse_bind_matrices, {16, 16}, where);
        if (!data) return std::nullopt;
        if (data->values.size() < 16 * matrices.size()) {
            problems_.error(where, fmt::format("{} inverse bind matrices for {} joints", data->values.size() / 16,
                                               matrices.size()));
            return std::nullopt;
        }
        for (std::size_t j = 0; j < matrices.size(); ++j)
            for (std::size_t i = 0; i < 16; ++i)
                matrices[j][static_cast<int>(i / 4)][static_cast<int>(i % 4)] =
                    static_cast<double>(data->values[16 * j + i]);
    }
    for (std::size_t j = 0; j < matrices.size(); ++j) {
        const std::optional<Mat4d>& joint = nodes_.to_world(skin.joints[j]);
        if (!joint) {
            problems_.error(where,
                            fmt::format("joint {} of the skin, node {}, is not in the scene", j, skin.joints[j]));
            return std::nullopt;
        }
        binding.to_world.push_back(matrices[j] * *joint);
        binding.moves = binding.moves || !nodes_.motion(skin.joints[j]).empty();
    }
    return binding;
}

}  // namespace etendue
