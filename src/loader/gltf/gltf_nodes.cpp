#include "loader/gltf/gltf_nodes.h"

#include "core/shown_text.h"
#include "loader/gltf/gltf_instancing.h"
#include "loader/gltf/gltf_lights.h"
#include "loader/gltf/gltf_mesh_deformer.h"
#include "loader/gltf/gltf_posed_nodes.h"
#include "loader/gltf/gltf_scene_graph.h"
#include "loader/gltf/gltf_transform.h"
#include "loader/gltf/gltf_value.h"
#include "loader/gltf/vertex_data.h"
#include "scene/transform.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Most nodes of a file, and so most cameras and lights.
constexpr std::size_t kMaxNodes = std::size_t{1} << 24;

/// About what each place of a mesh takes, from its description to Embree's node of it.
constexpr std::uint64_t kBytesOfPlace = 1024;
/// About what each primitive of a placed mesh takes besides: its slot for a light and its box.
constexpr std::uint64_t kBytesOfPlacedPrimitive = 64;

/// Returns about what a name of `size` bytes takes where it is placed: a long one is copied from description to
/// description, and a short one hardly counts.
std::uint64_t bytes_of_name(std::size_t size) {
    constexpr std::size_t kLong = 256;
    constexpr std::uint64_t kCopies = 8;
    return size > kLong ? kCopies * size : size;
}

/// Returns the planes that the file's camera has; without a far one, it sees everything.
ClipDesc clip_of(const auto& camera) {
    ClipDesc clip{.start = static_cast<float>(camera.znear)};
    if (camera.zfar > 0.0) clip.end = static_cast<float>(camera.zfar);
    return clip;
}

/// Moves the transforms at which a moving mesh has lost a dimension a little towards the nearest at which it has not:
/// rays are traced in the mesh's own space. False if the transform is singular all the time.
bool open_singular_steps(InstanceDesc& instance) {
    const auto is_open = [&] {
        return is_invertible(instance.to_world) && std::ranges::all_of(instance.motion, is_invertible);
    };
    if (is_open()) return true;
    constexpr float kOpening = 0.01f;
    const std::vector<Mat4f> steps = instance.motion;
    const auto opened = [&](const Mat4f& step, double place) {
        const Mat4f* nearest = nullptr;
        double least = 0.0;
        for (const Mat4f& other : steps) {
            const double away = std::abs(static_cast<double>(&other - steps.data()) - place);
            if (is_invertible(other) && (nearest == nullptr || away < least)) {
                nearest = &other;
                least = away;
            }
        }
        return nearest != nullptr ? step * (1.0f - kOpening) + *nearest * kOpening : step;
    };
    for (std::size_t i = 0; i < steps.size(); ++i)
        if (!is_invertible(steps[i])) instance.motion[i] = opened(steps[i], static_cast<double>(i));
    if (!is_invertible(instance.to_world))
        instance.to_world = opened(instance.to_world, 0.5 * (static_cast<double>(steps.size()) - 1.0));
    return is_open();
}

/// Turns one node after the other into what it places.
class Placer {
  public:
    Placer(const GltfDocument& document, AccessorReader& accessors, MeshDeformer& deformer, const PosedNodes& nodes,
           SceneDesc& scene, ProblemList& problems)
        : document_(document),
          accessors_(accessors),
          deformer_(deformer),
          nodes_(nodes),
          scene_(scene),
          problems_(problems),
          lights_(document, accessors, scene, problems),
          longest_light_name_(LightReader::longest_name(document)) {}

    /// Adds to the scene every node that the scene shows, parents before their children.
    void add_nodes(std::span<const int> parents) {
        node_index_.assign(document_.model.nodes.size(), NodeDesc::kNone);
        for (const PlacedNode& placed : nodes_.placed()) {
            const auto node = static_cast<std::size_t>(placed.node);
            node_index_[node] = static_cast<std::uint32_t>(scene_.nodes.size());
            const int parent = parents[node];
            scene_.nodes.push_back(
                {document_.model.nodes[node].name,
                 parent == kNoParent ? NodeDesc::kNone : node_index_[static_cast<std::size_t>(parent)],
                 static_cast<std::uint32_t>(placed.node), to_float(placed.to_world),
                 motion_of_node(placed.node, document_.at(fmt::format("/nodes/{}", placed.node)))});
        }
    }

    /// Places the meshes, lights and camera of the node `placed`, or only the camera if the node is not visible.
    void place(const PlacedNode& placed) {
        current_ = node_index_[static_cast<std::size_t>(placed.node)];
        const tinygltf::Node& node = document_.model.nodes[static_cast<std::size_t>(placed.node)];
        const SourceLocation where = document_.at(fmt::format("/nodes/{}", placed.node));
        const std::span<const Mat4d> motion = nodes_.motion(placed.node);
        if (placed.visible && node.mesh >= 0) place_meshes(node, placed, where);
        const bool shines = placed.visible && LightReader::has_light(node);
        if (node.camera < 0 && !shines) return;

        const std::optional<Mat4f> rigid = rigid_part(to_float(placed.to_world));
        if (!rigid) {
            problems_.warning(where, "the node's transform is singular: its camera and light are left out");
            return;
        }
        if (!accessors_.allocate(1, kBytesOfPlace + bytes_of_name(node.name.size()) + name_bytes(node), where)) return;
        if (node.camera >= 0) place_camera(node, *rigid, motion);
        if (node.camera >= 0 && placed.to_world.determinant() < 0.0)
            problems_.note(where, "mirrors its camera, but the image is not mirrored: cameras have no scale in glTF");
        if (shines) {
            const std::size_t before = scene_.lights.size();
            lights_.place(node, *rigid, where);
            if (!motion.empty()) move_lights(std::span(scene_.lights).subspan(before), *rigid, motion, where);
        }
    }

    /// Returns the bytes that names of the node's camera and light may take.
    [[nodiscard]] std::uint64_t name_bytes(const tinygltf::Node& node) const {
        std::uint64_t bytes = 0;
        if (node.camera >= 0)
            bytes = bytes_of_name(document_.model.cameras[static_cast<std::size_t>(node.camera)].name.size());
        if (LightReader::has_light(node)) bytes += bytes_of_name(longest_light_name_);
        return bytes;
    }

  private:
    /// Returns how a node moves while the shutter is open, for what render.json puts there.
    [[nodiscard]] TransformMotion motion_of_node(int node, const SourceLocation& where) {
        const std::span<const Mat4d> steps = nodes_.motion(node);
        if (steps.empty() || !accessors_.allocate(steps.size(), sizeof(Mat4f), where)) return {};
        TransformMotion motion = thin_out(steps, Bounds{Vec3f(-1.0f), Vec3f(1.0f)});
        return std::ranges::all_of(motion, is_invertible) ? motion : TransformMotion();
    }

    /// Returns the rigid parts of the steps of `motion`, thinned out; `to_world` stands in for a step that has none.
    [[nodiscard]] static std::vector<Mat4f> rigid_poses(const Mat4f& to_world, std::span<const Mat4d> motion) {
        std::vector<Mat4f> poses;
        for (const Mat4d& step : motion) poses.push_back(rigid_part(to_float(step)).value_or(to_world));
        return poses.empty() ? poses : thin_out_poses(poses);
    }

    /// Gives `lights`, those of one node, the motion of the node.
    void move_lights(std::span<LightDesc> lights, const Mat4f& to_world, std::span<const Mat4d> motion,
                     const SourceLocation& where) {
        const std::vector<Mat4f> poses = rigid_poses(to_world, motion);
        if (!accessors_.allocate(lights.size() * poses.size(), sizeof(Mat4f), where)) return;
        for (LightDesc& light : lights) light.motion = poses;
    }

    /// Places the mesh of `node` everywhere the node has it.
    void place_meshes(const tinygltf::Node& node, const PlacedNode& placed, const SourceLocation& where) {
        const MeshDeformer::Result mesh = deformer_.deform(placed.node, where);
        const tinygltf::Value* instancing = find_extension(node.extensions, "EXT_mesh_gpu_instancing");
        if (instancing != nullptr && !mesh.is_in_world_space)
            place_instances(node, mesh.mesh, *instancing, placed, where);
        else if (!allocate_places(1, node, mesh.mesh, where))
            return;
        else if (mesh.is_in_world_space)
            place_mesh(node, mesh.mesh, Mat4d(), {}, where, true);
        else
            place_mesh(node, mesh.mesh, placed.to_world, nodes_.motion(placed.node), where);
    }

    /// Takes the memory of `count` places of `mesh` from what may still be decoded.
    [[nodiscard]] bool allocate_places(std::size_t count, const tinygltf::Node& node, Handle<MeshDesc> mesh,
                                       const SourceLocation& where) {
        const std::size_t primitives = scene_.meshes[static_cast<std::size_t>(mesh.index)].primitives.size();
        // Every place copies the name, and a file may make names of any length.
        const std::size_t name =
            std::max(node.name.size(), scene_.meshes[static_cast<std::size_t>(mesh.index)].name.size());
        return accessors_.allocate(count, kBytesOfPlace + bytes_of_name(name) + kBytesOfPlacedPrimitive * primitives,
                                   where);
    }

    void place_instances(const tinygltf::Node& node, Handle<MeshDesc> mesh, const tinygltf::Value& extension,
                         const PlacedNode& placed, const SourceLocation& where) {
        const SourceLocation at = document_.at(where.pointer + "/extensions/EXT_mesh_gpu_instancing");
        const std::optional<std::vector<Mat4d>> transforms =
            read_instance_transforms(extension, accessors_, at, problems_);
        if (!transforms) return;
        const std::span<const Mat4d> node_motion = nodes_.motion(placed.node);
        if (!allocate_places(transforms->size(), node, mesh, at) ||
            !accessors_.allocate(transforms->size() * node_motion.size(), sizeof(Mat4f), at))
            return;
        std::vector<Mat4d> motion(node_motion.size());
        for (const Mat4d& to_node : *transforms) {
            std::ranges::transform(node_motion, motion.begin(), [&](const Mat4d& m) { return to_node * m; });
            place_mesh(node, mesh, to_node * placed.to_world, motion, where);
        }
    }

    void place_mesh(const tinygltf::Node& node, Handle<MeshDesc> handle, const Mat4d& to_world,
                    std::span<const Mat4d> motion, const SourceLocation& where, bool is_deformed = false) {
        const MeshDesc& mesh = scene_.meshes[static_cast<std::size_t>(handle.index)];
        if (mesh.primitives.empty()) return;  // reported with the mesh
        InstanceDesc instance{
            node.name.empty() ? mesh.name : node.name, handle, to_float(to_world), {}, where, current_, is_deformed};
        if (!motion.empty()) instance.motion = thin_out(motion, bounds_of(handle));
        if (!open_singular_steps(instance)) {
            Mat4f translation;
            for (int axis = 0; axis < 3; ++axis) translation[3][axis] = instance.to_world[3][axis];
            const Handle<MeshDesc> flat = instance.motion.empty() && is_finite(instance.to_world)
                                              ? flattened(handle, to_world, where)
                                              : Handle<MeshDesc>();
            problems_.warning(where, flat ? "the node's transform is singular: its mesh is shown flat"
                                          : "the node's transform is singular: its mesh is left out");
            if (!flat) return;
            instance.mesh = flat;
            instance.to_world = translation;
        }
        scene_.instances.push_back(std::move(instance));
    }

    /// Returns the mesh `handle` made flat by `to_world`, which cannot be inverted, without its translation; nothing if
    /// no triangle has an area left. The flat mesh has the normals of its triangles. Places that differ in translation
    /// alone share it.
    Handle<MeshDesc> flattened(Handle<MeshDesc> handle, const Mat4d& to_world, const SourceLocation& where) {
        FlatShape shape;
        shape.first = handle.index;
        for (int i = 0; i < 9; ++i) shape.second[static_cast<std::size_t>(i)] = to_world[i / 3][i % 3];
        const auto [entry, is_new] = flat_meshes_.try_emplace(shape);
        if (is_new) entry->second = flatten(scene_.meshes[static_cast<std::size_t>(handle.index)], to_world, where);
        return entry->second;
    }

    Handle<MeshDesc> flatten(const MeshDesc& mesh, const Mat4d& to_world, const SourceLocation& where) {
        if (!accessors_.allocate(1, kBytesOfMesh, where)) return {};
        MeshDesc flat;
        flat.name = mesh.name;
        flat.location = mesh.location;
        for (const PrimitiveDesc& primitive : mesh.primitives) {
            if (!accessors_.allocate(primitive.positions.size() + primitive.triangles.size(), sizeof(Vec3f) * 4, where))
                return {};
            PrimitiveDesc& copy = flat.primitives.emplace_back(primitive);
            copy.normals.clear();
            copy.tangents.clear();
            copy.motion.clear();
            for (Vec3f& position : copy.positions) {
                Vec3d moved(0.0);
                to_world.multDirMatrix(Vec3d(position), moved);
                position = Vec3f(moved);
            }
            static_cast<void>(remove_degenerate_triangles(copy.triangles, copy.positions));
            const bool is_finite_all = std::ranges::all_of(copy.positions, [](const Vec3f& p) { return is_finite(p); });
            if (copy.triangles.empty() || !is_finite_all) flat.primitives.pop_back();
        }
        if (flat.primitives.empty()) return {};
        scene_.meshes.push_back(std::move(flat));
        return {static_cast<std::int32_t>(scene_.meshes.size()) - 1};
    }

    /// Returns the bounds of the mesh `handle` at rest, found once for each mesh, however often the mesh is placed.
    const Bounds& bounds_of(Handle<MeshDesc> handle) {
        const auto [entry, is_new] = bounds_.try_emplace(handle.index);
        if (is_new)
            for (const PrimitiveDesc& primitive : scene_.meshes[static_cast<std::size_t>(handle.index)].primitives)
                for (const Vec3f& p : primitive.positions) entry->second.extend(p);
        return entry->second;
    }

    void place_camera(const tinygltf::Node& node, const Mat4f& to_world, std::span<const Mat4d> motion) {
        const tinygltf::Camera& source = document_.model.cameras[static_cast<std::size_t>(node.camera)];
        CameraDesc camera;
        camera.name = camera_names_.take(source.name.empty() ? node.name : source.name, "camera");
        camera.node = node.name;
        camera.to_world = to_world;
        // Its scale has no meaning.
        camera.motion = rigid_poses(to_world, motion);
        camera.location = document_.at(fmt::format("/cameras/{}", node.camera));
        if (source.type == "orthographic") {
            camera.type = CameraType::Orthographic;
            if (source.orthographic.xmag < 0.0 || source.orthographic.ymag < 0.0)
                problems_.warning(document_.at(fmt::format("/cameras/{}/orthographic", node.camera)),
                                  "xmag and ymag should not be negative: their signs are ignored, the view is not "
                                  "mirrored");
            camera.ymag = static_cast<float>(std::abs(source.orthographic.ymag));
            const double aspect = std::abs(source.orthographic.xmag / source.orthographic.ymag);
            camera.aspect_ratio = std::isfinite(aspect) ? static_cast<float>(aspect) : 0.0f;
            camera.file_clip = clip_of(source.orthographic);
        } else {
            camera.yfov = static_cast<float>(source.perspective.yfov);
            camera.aspect_ratio = static_cast<float>(source.perspective.aspectRatio);
            camera.file_clip = clip_of(source.perspective);
        }
        scene_.cameras.push_back(std::move(camera));
    }

    const GltfDocument& document_;
    AccessorReader& accessors_;
    MeshDeformer& deformer_;
    const PosedNodes& nodes_;
    SceneDesc& scene_;
    ProblemList& problems_;
    LightReader lights_;
    std::size_t longest_light_name_;           ///< bytes
    FreeNames camera_names_;                   ///< cameras are chosen by name, so each has one of its own
    std::vector<std::uint32_t> node_index_;    ///< index in the scene of each of the file's nodes
    std::uint32_t current_ = NodeDesc::kNone;  ///< the node that is placed, in the scene's
    std::map<std::int32_t, Bounds> bounds_;    ///< by mesh
    /// A mesh, and the transform that makes it flat, without its last row.
    using FlatShape = std::pair<std::int32_t, std::array<double, 9>>;
    std::map<FlatShape, Handle<MeshDesc>> flat_meshes_;
};

/// How much of everything that nodes place a scene has.
class PlacedCounts {
  public:
    explicit PlacedCounts(const SceneDesc& scene)
        : meshes_(scene.meshes.size()),
          nodes_(scene.nodes.size()),
          instances_(scene.instances.size()),
          cameras_(scene.cameras.size()),
          ies_profiles_(scene.ies_profiles.size()),
          lights_(scene.lights.size()) {}

    /// Removes what has been placed since.
    void restore(SceneDesc& scene) const {
        const auto keep = [](auto& things, std::size_t count) {
            things.erase(things.begin() + static_cast<std::ptrdiff_t>(count), things.end());
        };
        keep(scene.meshes, meshes_);
        keep(scene.nodes, nodes_);
        keep(scene.instances, instances_);
        keep(scene.cameras, cameras_);
        keep(scene.ies_profiles, ies_profiles_);
        keep(scene.lights, lights_);
    }

  private:
    std::size_t meshes_;
    std::size_t nodes_;
    std::size_t instances_;
    std::size_t cameras_;
    std::size_t ies_profiles_;
    std::size_t lights_;
};

/// Adds to `scene` all that `nodes` place.
void place_all(const GltfDocument& document, AccessorReader& accessors, std::span<const MeshDeformation> deformations,
               const PosedNodes& nodes, std::span<const int> parents, SceneDesc& scene, ProblemList& problems) {
    MeshDeformer deformer(document, accessors, deformations, nodes, scene, problems);
    Placer placer(document, accessors, deformer, nodes, scene, problems);
    placer.add_nodes(parents);
    for (const PlacedNode& placed : nodes.placed()) placer.place(placed);
}

}  // namespace

void read_nodes(const GltfDocument& document, AccessorReader& accessors, std::span<const MeshDeformation> deformations,
                const AnimationSampler* animation, const RenderSettings& settings, SceneDesc& scene,
                ProblemList& problems) {
    if (document.model.nodes.size() > kMaxNodes) {
        problems.error(document.at("/nodes"), fmt::format("more than {} nodes", kMaxNodes));
        return;
    }
    ProblemList structure;
    choose_scene(document, settings, scene, structure);
    const std::vector<int> parents = find_parents(document, structure);
    check_cycles(document, parents, structure);
    const std::vector<int> roots =
        structure.has_errors() ? std::vector<int>() : find_roots(document, scene.shown_scene, parents, structure);
    for (const Problem& problem : structure.all()) problems.add(problem);
    if (structure.has_errors()) return;

    PosedNodes nodes(document, roots, parents, animation, settings, accessors, problems);
    const PlacedCounts counts(scene);
    const ProblemList before = problems;
    place_all(document, accessors, deformations, nodes, parents, scene, problems);
    // Only what is placed shows whether it is far away. If so, nothing of it is precise, and all is placed anew.
    if (const Vec3d origin = choose_origin(compute_bounds(scene)); origin != Vec3d(0.0) && !problems.has_errors()) {
        counts.restore(scene);
        problems = before;
        scene.origin = origin;
        nodes.move_origin(origin);
        place_all(document, accessors, deformations, nodes, parents, scene, problems);
    }
}

SweptSpace swept_by_animation(const GltfDocument& document, std::span<const MeshDeformation> deformations,
                              const AnimationSampler& animation, const RenderSettings& settings, SceneDesc& scene) {
    constexpr int kMoments = 33;
    ProblemList problems;  // `read_nodes` has told of them
    const std::vector<int> parents = find_parents(document, problems);
    const std::vector<int> roots = find_roots(document, scene.shown_scene, parents, problems);
    RenderSettings shown = settings;
    shown.frame.reset();
    shown.shutter = {};
    std::vector<InstanceDesc> instances;
    std::swap(instances, scene.instances);
    const PlacedCounts counts(scene);
    const auto [first, last] = animation.time_span();
    SweptSpace swept;
    AccessorReader accessors(document, problems);
    for (int i = 0; i < kMoments && !problems.has_errors(); ++i) {
        shown.time_code = std::lerp(first, last, static_cast<double>(i) / (kMoments - 1));
        accessors.forget();
        PosedNodes nodes(document, roots, parents, &animation, shown, accessors, problems);
        nodes.move_origin(scene.origin);
        place_all(document, accessors, deformations, nodes, parents, scene, problems);
        swept.extend(scene);
        counts.restore(scene);
    }
    std::swap(instances, scene.instances);
    return problems.has_errors() ? SweptSpace() : swept;
}

}  // namespace etendue
