#include "loader/gltf/gltf_nodes.h"

#include "loader/gltf/gltf_instancing.h"
#include "loader/gltf/gltf_lights.h"
#include "loader/gltf/gltf_mesh_deformer.h"
#include "loader/gltf/gltf_transform.h"
#include "loader/gltf/gltf_value.h"
#include "scene/transform.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Most nodes of a file, and so most instances, cameras and lights.
constexpr std::size_t kMaxNodes = std::size_t{1} << 24;

constexpr int kNoParent = -1;

/// The parent of every node. Errors for nodes with two.
std::vector<int> find_parents(const GltfDocument& document, ProblemList& problems) {
    const std::vector<tinygltf::Node>& nodes = document.model.nodes;
    std::vector<int> parents(nodes.size(), kNoParent);
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        for (std::size_t c = 0; c < nodes[n].children.size(); ++c) {
            const auto child = static_cast<std::size_t>(nodes[n].children[c]);
            if (parents[child] == kNoParent) {
                parents[child] = static_cast<int>(n);
                continue;
            }
            problems.error(document.at(fmt::format("/nodes/{}/children/{}", n, c)),
                           fmt::format("node {} already is a child of node {}", child, parents[child]));
        }
    }
    return parents;
}

/// One error for each cycle. Every node has one parent at most, so walking up either ends or meets its own track.
void check_cycles(const GltfDocument& document, const std::vector<int>& parents, ProblemList& problems) {
    constexpr std::size_t kUnseen = 0;
    std::vector<std::size_t> walk_of(parents.size(), kUnseen);
    for (std::size_t start = 0; start < parents.size(); ++start) {
        int node = static_cast<int>(start);
        while (node != kNoParent && walk_of[static_cast<std::size_t>(node)] == kUnseen) {
            walk_of[static_cast<std::size_t>(node)] = start + 1;
            node = parents[static_cast<std::size_t>(node)];
        }
        if (node != kNoParent && walk_of[static_cast<std::size_t>(node)] == start + 1) {
            problems.error(document.at(fmt::format("/nodes/{}", node)), "the node is its own ancestor");
        }
    }
}

/// The nodes to start from.
std::vector<int> find_roots(const GltfDocument& document, const std::vector<int>& parents, ProblemList& problems) {
    const tinygltf::Model& model = document.model;
    if (model.scenes.empty()) {
        std::vector<int> roots;
        for (std::size_t n = 0; n < parents.size(); ++n) {
            if (parents[n] == kNoParent) roots.push_back(static_cast<int>(n));
        }
        if (!roots.empty()) {
            problems.warning(document.at(""), "the file has no scene: all nodes without a parent are shown");
        }
        return roots;
    }
    const std::size_t index = model.defaultScene >= 0 ? static_cast<std::size_t>(model.defaultScene) : 0;
    const std::vector<int>& roots = model.scenes[index].nodes;
    std::vector<bool> seen(parents.size(), false);
    for (std::size_t i = 0; i < roots.size(); ++i) {
        const auto root = static_cast<std::size_t>(roots[i]);
        const SourceLocation where = document.at(fmt::format("/scenes/{}/nodes/{}", index, i));
        if (parents[root] != kNoParent) {
            problems.error(where, fmt::format("node {} is a child of node {}, so it is no root of the scene", root,
                                              parents[root]));
        } else if (seen[root]) {
            problems.error(where, fmt::format("node {} is listed twice", root));
        }
        seen[root] = true;
    }
    return roots;
}

Mat4d local_transform(const tinygltf::Node& node, const NodePose& pose, const SourceLocation& where,
                      ProblemList& problems) {
    if (node.matrix.size() == 16) {
        const std::optional<Mat4d> matrix = affine_matrix(node.matrix);
        if (!matrix) problems.error(where, "the matrix is not affine: its fourth row must be 0, 0, 0, 1");
        if (pose.translation || pose.rotation || pose.scale)
            problems.warning(where, "the node has a matrix and cannot be animated: its animation is ignored");
        return matrix.value_or(Mat4d());
    }
    // What is animated, or else what the node has.
    const auto numbers = [](const auto& animated, const std::vector<double>& own) {
        return animated ? std::vector<double>(animated->begin(), animated->end()) : own;
    };
    const std::vector<double> scale = numbers(pose.scale, node.scale);
    const std::vector<double> rotation = numbers(pose.rotation, node.rotation);
    const std::vector<double> translation = numbers(pose.translation, node.translation);
    Mat4d result;
    if (scale.size() == 3) result.setScale(Imath::V3d(scale[0], scale[1], scale[2]));
    if (rotation.size() == 4) {
        const std::optional<Mat4d> matrix = rotation_matrix({rotation[0], rotation[1], rotation[2], rotation[3]});
        if (!matrix) problems.warning(where, "the rotation is a zero quaternion and is ignored");
        result *= matrix.value_or(Mat4d());
    }
    if (translation.size() == 3) {
        for (int i = 0; i < 3; ++i) result[3][i] = translation[static_cast<std::size_t>(i)];
    }
    return result;
}

const NodePose& pose_of(const NodePoses& poses, int node) {
    static const NodePose kAtRest;
    const auto found = poses.find(node);
    return found == poses.end() ? kAtRest : found->second;
}

/// Turns one node after the other into what it places.
class Placer {
  public:
    Placer(const GltfDocument& document, AccessorReader& accessors, MeshDeformer& deformer, SceneDesc& scene,
           ProblemList& problems)
        : document_(document),
          accessors_(accessors),
          deformer_(deformer),
          scene_(scene),
          problems_(problems),
          lights_(document, accessors, scene, problems) {}

    /// Of a node that is not `visible` only the camera is placed.
    void place(const tinygltf::Node& node, const NodePose& pose, const Mat4d& node_to_world,
               const SourceLocation& where, bool visible) {
        if (visible && node.mesh >= 0) {
            const MeshDeformer::Result mesh = deformer_.deform(node, pose, where);
            const tinygltf::Value* instancing = find_extension(node.extensions, "EXT_mesh_gpu_instancing");
            if (mesh.is_in_world_space)
                place_mesh(node, mesh.mesh, Mat4f(), where);
            else if (instancing != nullptr)
                place_instances(node, mesh.mesh, *instancing, node_to_world, where);
            else
                place_mesh(node, mesh.mesh, to_float(node_to_world), where);
        }
        const Mat4f to_world = to_float(node_to_world);
        const bool shines = visible && LightReader::has_light(node);
        if (node.camera < 0 && !shines) return;

        const std::optional<Mat4f> rigid = rigid_part(to_world);
        if (!rigid) {
            problems_.warning(where, "the node's transform is singular: its camera and light are left out");
            return;
        }
        if (node.camera >= 0) place_camera(node, *rigid);
        if (shines) lights_.place(node, *rigid, where);
    }

  private:
    void place_instances(const tinygltf::Node& node, Handle<MeshDesc> mesh, const tinygltf::Value& extension,
                         const Mat4d& node_to_world, const SourceLocation& where) {
        const SourceLocation at = document_.at(where.pointer + "/extensions/EXT_mesh_gpu_instancing");
        const std::optional<std::vector<Mat4d>> transforms =
            read_instance_transforms(extension, accessors_, at, problems_);
        if (!transforms) return;
        if (transforms->size() > kMaxNodes - std::min(kMaxNodes, scene_.instances.size())) {
            problems_.error(at, fmt::format("more than {} instances in all", kMaxNodes));
            return;
        }
        for (const Mat4d& to_node : *transforms) place_mesh(node, mesh, to_float(to_node * node_to_world), where);
    }

    void place_mesh(const tinygltf::Node& node, Handle<MeshDesc> handle, const Mat4f& to_world,
                    const SourceLocation& where) {
        const MeshDesc& mesh = scene_.meshes[static_cast<std::size_t>(handle.index)];
        if (mesh.primitives.empty()) return;  // reported with the mesh
        if (!is_invertible(to_world)) {
            problems_.warning(where, "the node's transform is singular: its mesh is left out");
            return;
        }
        InstanceDesc& instance = scene_.instances.emplace_back();
        instance.name = node.name.empty() ? mesh.name : node.name;
        instance.mesh = handle;
        instance.to_world = to_world;
        instance.location = where;
    }

    void place_camera(const tinygltf::Node& node, const Mat4f& to_world) {
        const tinygltf::Camera& source = document_.model.cameras[static_cast<std::size_t>(node.camera)];
        CameraDesc camera;
        camera.name = unique_camera_name(source.name.empty() ? node.name : source.name);
        camera.to_world = to_world;
        camera.location = document_.at(fmt::format("/cameras/{}", node.camera));
        if (source.type == "orthographic") {
            camera.type = CameraType::Orthographic;
            camera.ymag = static_cast<float>(std::abs(source.orthographic.ymag));
            const double aspect = std::abs(source.orthographic.xmag / source.orthographic.ymag);
            camera.aspect_ratio = std::isfinite(aspect) ? static_cast<float>(aspect) : 0.0f;
        } else {
            camera.yfov = static_cast<float>(source.perspective.yfov);
            camera.aspect_ratio = static_cast<float>(source.perspective.aspectRatio);
        }
        scene_.cameras.push_back(std::move(camera));
    }

    /// Cameras are chosen by name, so each has one of its own.
    std::string unique_camera_name(const std::string& wanted) {
        const std::string base = wanted.empty() ? "camera" : wanted;
        std::string name = base;
        for (int& n = last_number_[base]; !camera_names_.insert(name).second;)
            name = fmt::format("{}-{}", base, ++n + 1);
        return name;
    }

    const GltfDocument& document_;
    AccessorReader& accessors_;
    MeshDeformer& deformer_;
    SceneDesc& scene_;
    ProblemList& problems_;
    LightReader lights_;
    std::set<std::string> camera_names_;
    std::map<std::string, int> last_number_;  ///< by name, so that finding a free one does not start over
};

/// A node of the scene, where it is.
struct PlacedNode {
    int node;
    Mat4d to_world;
    bool visible = true;  ///< KHR_node_visibility: it and all nodes above it are
};

bool is_visible(const tinygltf::Node& node) {
    const tinygltf::Value* extension = find_extension(node.extensions, "KHR_node_visibility");
    return extension == nullptr || !extension->Has("visible") || extension->Get("visible").Get<bool>();
}

/// Depth first over the forest, with a stack of its own: hierarchies may be as deep as the file likes.
std::vector<PlacedNode> walk(const GltfDocument& document, const std::vector<int>& roots, const NodePoses& poses,
                             ProblemList& problems) {
    std::vector<PlacedNode> placed;
    std::vector<PlacedNode> stack;  // with the transforms and the visibility of their parents
    for (auto root = roots.rbegin(); root != roots.rend(); ++root) stack.push_back({*root, Mat4d()});
    while (!stack.empty()) {
        PlacedNode visit = stack.back();
        stack.pop_back();
        const tinygltf::Node& node = document.model.nodes[static_cast<std::size_t>(visit.node)];
        const SourceLocation where = document.at(fmt::format("/nodes/{}", visit.node));
        visit.to_world = local_transform(node, pose_of(poses, visit.node), where, problems) * visit.to_world;
        visit.visible = visit.visible && is_visible(node);
        for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
            stack.push_back({*child, visit.to_world, visit.visible});
        placed.push_back(visit);
    }
    return placed;
}

}  // namespace

void read_nodes(const GltfDocument& document, AccessorReader& accessors, std::span<const MeshDeformation> deformations,
                const NodePoses& poses, SceneDesc& scene, ProblemList& problems) {
    if (document.model.nodes.size() > kMaxNodes) {
        problems.error(document.at("/nodes"), fmt::format("more than {} nodes", kMaxNodes));
        return;
    }
    ProblemList structure;
    const std::vector<int> parents = find_parents(document, structure);
    check_cycles(document, parents, structure);
    const std::vector<int> roots = find_roots(document, parents, structure);
    for (const Problem& problem : structure.all()) problems.add(problem);
    if (structure.has_errors()) return;

    const std::vector<PlacedNode> nodes = walk(document, roots, poses, problems);
    std::vector<std::optional<Mat4d>> to_world(document.model.nodes.size());
    for (const PlacedNode& node : nodes) to_world[static_cast<std::size_t>(node.node)] = node.to_world;
    MeshDeformer deformer(document, accessors, deformations, to_world, scene, problems);
    Placer placer(document, accessors, deformer, scene, problems);
    for (const PlacedNode& node : nodes)
        placer.place(document.model.nodes[static_cast<std::size_t>(node.node)], pose_of(poses, node.node),
                     node.to_world, document.at(fmt::format("/nodes/{}", node.node)), node.visible);
    if (scene.instances.empty()) problems.warning(document.at(""), "the scene shows no triangles");
}

}  // namespace etendue
