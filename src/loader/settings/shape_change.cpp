#include "loader/settings/shape_change.h"

#include "core/shown_text.h"
#include "loader/json_text.h"
#include "loader/settings/known_names.h"

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Puts shapes into a scene.
class ShapePlacer {
  public:
    ShapePlacer(SceneDesc& scene, ProblemList& problems)
        : scene_(scene),
          problems_(problems),
          taken_by_(scene.instances.size()),
          known_materials_([&scene] { return names_of(scene.materials); }),
          known_nodes_([&scene] { return names_of(scene.nodes); }) {}

    void put(const std::string& name, const ShapeChange& change) {
        Handle<MaterialDesc> material;
        if (!change.material.empty()) {
            const auto found = std::ranges::find(scene_.materials, change.material, &MaterialDesc::name);
            if (found == scene_.materials.end())
                return report(change, "material",
                              fmt::format("the scene has no material '{}'; {}", shown(change.material),
                                          known_materials_.hint(change.material, problems_)));
            material.index = static_cast<std::int32_t>(found - scene_.materials.begin());
        }
        if (change.place.position) {
            add(name, change, material, {.to_world = placed(change.place, scene_.origin)});
            return;
        }
        const std::string& node = change.place.node.empty() ? name : change.place.node;
        std::vector<std::uint32_t> nodes;
        for (std::uint32_t n = 0; n < scene_.nodes.size(); ++n)
            if (scene_.nodes[n].name == node) nodes.push_back(n);
        if (nodes.empty() && change.place.node.empty())
            return problems_.error(change.location,
                                   fmt::format("nothing says where the shape is: give it a \"position\" or a \"node\", "
                                               "or the name of one; {}",
                                               known_nodes_.hint(node, problems_)));
        if (nodes.empty())
            return report(
                change, "node",
                fmt::format("the scene has no node '{}'; {}", shown(node), known_nodes_.hint(node, problems_)));
        if (replace_meshes(name, change, material, nodes)) return;
        for (const std::uint32_t n : nodes) {
            add(name, change, material, {scene_.nodes[n].to_world, scene_.nodes[n].motion, n});
        }
    }

  private:
    void report(const ShapeChange& change, std::string_view key, std::string message) {
        problems_.error({change.location.file, child_pointer(change.location.pointer, key)}, std::move(message));
    }

    /// Puts the shape where the meshes of these nodes are; false if they have none.
    bool replace_meshes(const std::string& name, const ShapeChange& change, Handle<MaterialDesc> material,
                        const std::vector<std::uint32_t>& nodes) {
        std::map<std::int32_t, Handle<MeshDesc>> shape_of_mesh;
        // Those of the file: other shapes may stand at the node, too.
        for (std::size_t i = 0; i < taken_by_.size(); ++i) {
            InstanceDesc& instance = scene_.instances[i];
            if (std::ranges::find(nodes, instance.node) == nodes.end()) continue;
            if (!taken_by_[i].empty()) {
                problems_.error(change.location,
                                fmt::format("takes the place of the mesh whose place '{}' has taken; give one of them "
                                            "a \"position\"",
                                            shown(taken_by_[i])));
                return true;
            }
            if (instance.is_deformed) {
                problems_.error(change.location,
                                "would take the place of a mesh that a skin deforms, so that no transform says where "
                                "the shape is; give it a \"position\"");
                return true;
            }
            taken_by_[i] = name;
            const auto [entry, is_new] = shape_of_mesh.try_emplace(instance.mesh.index);
            if (is_new) {
                const std::vector<PrimitiveDesc>& primitives =
                    scene_.meshes[static_cast<std::size_t>(instance.mesh.index)].primitives;
                std::vector<VariantMaterial> variants;
                Handle<MaterialDesc> taken = material;
                if (!taken && !primitives.empty()) {
                    taken = primitives.front().material;
                    variants = primitives.front().variants;
                }
                entry->second = make_mesh(name, change, taken, std::move(variants));
            }
            instance.mesh = entry->second;
        }
        return !shape_of_mesh.empty();
    }

    /// A place where no mesh is.
    struct FreePlace {
        Mat4f to_world{};
        TransformMotion motion{};
        std::uint32_t node = NodeDesc::kNone;
    };

    void add(const std::string& name, const ShapeChange& change, Handle<MaterialDesc> material, FreePlace place) {
        if (!material)
            return problems_.error(change.location,
                                   "must have a \"material\", as there is no mesh whose place it takes");
        InstanceDesc instance;
        instance.name = name;
        instance.mesh = make_mesh(name, change, material, {});
        instance.to_world = place.to_world;
        instance.motion = std::move(place.motion);
        instance.location = change.location;
        instance.node = place.node;
        scene_.instances.push_back(std::move(instance));
    }

    Handle<MeshDesc> make_mesh(const std::string& name, const ShapeChange& change, Handle<MaterialDesc> material,
                               std::vector<VariantMaterial> variants) {
        PrimitiveDesc primitive;
        primitive.shape = change.shape;
        primitive.positions = change.shape.corners();
        primitive.material = material;
        primitive.variants = std::move(variants);
        primitive.location = change.location;
        MeshDesc& mesh = scene_.meshes.emplace_back();
        mesh.name = name;
        mesh.location = change.location;
        mesh.primitives.push_back(std::move(primitive));
        return {static_cast<std::int32_t>(scene_.meshes.size()) - 1};
    }

    SceneDesc& scene_;
    ProblemList& problems_;
    std::vector<std::string_view> taken_by_;  ///< by instance of the file, the shape that took its mesh's place
    KnownNames known_materials_;
    KnownNames known_nodes_;
};

}  // namespace

ShapeChange read_shape(const nlohmann::json& value, const SourceLocation& where, ProblemList& problems) {
    ShapeChange change;
    change.location = where;
    JsonObject object(value, where, problems);
    if (!object.has("type")) problems.error(where, "'type' is missing");
    const bool has_type = object.choice("type", kShapeKinds, change.shape.kind);
    const ShapeKind kind = change.shape.kind;
    const auto size = [&](std::string_view key, bool is_its_own, float standard) {
        float metres = standard;
        const bool is_said = object.number(key, kPositive, metres);
        if (is_said && has_type && !is_its_own)
            problems.error(object.at(key), fmt::format("a {} has no {}", shape_name(kind), key));
        return metres;
    };
    const bool is_rectangle = kind == ShapeKind::Rectangle;
    const float radius = size("radius", !is_rectangle, 0.5f);
    const float width = size("width", is_rectangle, 1.0f);
    const float height = size("height", is_rectangle || kind == ShapeKind::Cylinder, 1.0f);
    change.shape.half_size = Vec3f(radius);
    if (is_rectangle) change.shape.half_size = {0.5f * width, 0.5f * height, 0.5f};
    if (kind == ShapeKind::Cylinder) change.shape.half_size.y = 0.5f * height;
    object.text("material", change.material);
    read_place(object, change.place);
    object.finish();
    return change;
}

void apply_shapes(const std::map<std::string, ShapeChange>& changes, SceneDesc& scene, ProblemList& problems) {
    ShapePlacer placer(scene, problems);
    for (const auto& [name, change] : changes) placer.put(name, change);
}

}  // namespace etendue
