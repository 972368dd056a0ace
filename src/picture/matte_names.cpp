#include "picture/matte_names.h"

#include "core/shown_text.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Enough for what people build, and a bound on what a file of many deep nodes can make of it.
constexpr std::size_t kMostParts = 32;

std::string node_name(const NodeDesc& node) {
    return node.name.empty() ? fmt::format("unnamed_node_{}", node.number) : clean_matte_name(node.name);
}

/// Returns the name of the instance `index`, whatever other instances are called: its own, else that of its node, else,
/// for scenes that come from no file and have no nodes, "unnamed_node_" and `index`.
std::string own_name(const SceneDesc& scene, std::size_t index) {
    const InstanceDesc& instance = scene.instances[index];
    if (!instance.name.empty()) return clean_matte_name(instance.name);
    return instance.node != NodeDesc::kNone ? node_name(scene.nodes[instance.node])
                                            : fmt::format("unnamed_node_{}", index);
}

/// "top/middle/own".
std::string path_name(const SceneDesc& scene, const InstanceDesc& instance, std::string own) {
    if (instance.node == NodeDesc::kNone) return own;
    std::uint32_t node = scene.nodes[instance.node].parent;
    for (std::size_t parts = 1; node != NodeDesc::kNone && parts < kMostParts; ++parts) {
        own.insert(0, node_name(scene.nodes[node]) + "/");
        node = scene.nodes[node].parent;
    }
    return own;
}

/// Names of which none is there twice.
class UniqueNames {
  public:
    void take(const std::string& name) { taken_.insert(name); }
    /// `name`; where that is taken, '#' and `number` behind it, or a larger one if that is taken, too.
    [[nodiscard]] std::string unlike_others(const std::string& name, std::size_t number) {
        if (taken_.insert(name).second) return name;
        std::string numbered = fmt::format("{}#{}", name, number);
        if (taken_.insert(numbered).second) return numbered;
        // No number is tried twice, or files of many such names would take time by the square of them.
        std::size_t& next = next_[name];
        next = std::max(next, number + 1);
        do numbered = fmt::format("{}#{}", name, next++);
        while (!taken_.insert(numbered).second);
        return numbered;
    }

  private:
    std::set<std::string> taken_;
    std::map<std::string, std::size_t> next_;
};

}  // namespace

std::string clean_matte_name(std::string_view name) {
    constexpr std::size_t kLongest = 255;
    std::string clean(first_characters(name, kLongest));
    for (char& c : clean)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '_';
    return clean;
}

std::vector<std::string> object_names(const SceneDesc& scene) {
    const std::size_t count = scene.instances.size();
    // Instances without a node are objects of their own.
    const auto object_of = [&](std::size_t i) {
        const std::uint32_t node = scene.instances[i].node;
        return node != NodeDesc::kNone ? std::size_t{node} : scene.nodes.size() + i;
    };
    std::map<std::string, std::size_t> first_object;
    std::set<std::string> repeated;
    for (std::size_t i = 0; i < count; ++i) {
        std::string own = own_name(scene, i);
        const auto [known, is_new] = first_object.try_emplace(own, object_of(i));
        if (!is_new && known->second != object_of(i)) repeated.insert(std::move(own));
    }
    std::vector<std::string> names;
    std::map<std::size_t, std::string> name_of_object;
    UniqueNames unique;
    for (const auto& [name, ignored] : first_object)
        if (!repeated.contains(name)) unique.take(name);
    for (std::size_t i = 0; i < count; ++i) {
        const auto [known, is_new] = name_of_object.try_emplace(object_of(i));
        if (is_new) {
            std::string name = own_name(scene, i);
            if (repeated.contains(name)) {
                const InstanceDesc& instance = scene.instances[i];
                name = path_name(scene, instance, std::move(name));
                const bool has_node = instance.node != NodeDesc::kNone;
                name = unique.unlike_others(name, has_node ? scene.nodes[instance.node].number : i);
            }
            known->second = std::move(name);
        }
        names.push_back(known->second);
    }
    return names;
}

std::vector<std::string> asset_names(const SceneDesc& scene) {
    // Parents stand before their children.
    std::vector<std::uint32_t> top(scene.nodes.size());
    for (std::uint32_t n = 0; n < top.size(); ++n)
        top[n] = scene.nodes[n].parent == NodeDesc::kNone ? n : top[scene.nodes[n].parent];
    // Without a name of its own, one is called by its mesh, as the object is, for all that is below it, too.
    std::map<std::uint32_t, std::string> mesh_of_top;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const std::uint32_t node = scene.instances[i].node;
        if (node != NodeDesc::kNone && top[node] == node && scene.nodes[node].name.empty())
            mesh_of_top.try_emplace(node, own_name(scene, i));
    }
    std::vector<std::string> names;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const std::uint32_t node = scene.instances[i].node;
        if (node == NodeDesc::kNone) {
            names.push_back(own_name(scene, i));
            continue;
        }
        const auto mesh = mesh_of_top.find(top[node]);
        names.push_back(mesh != mesh_of_top.end() ? mesh->second : node_name(scene.nodes[top[node]]));
    }
    return names;
}

std::vector<std::string> material_names(const SceneDesc& scene) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const MaterialDesc& material = scene.materials[i];
        // That of primitives without one stands behind those of the file, and nowhere in it.
        const bool is_default = !material.location.file.empty() && material.location.pointer.empty();
        if (!material.name.empty())
            names.push_back(clean_matte_name(material.name));
        else
            names.push_back(is_default ? "default_material" : fmt::format("unnamed_material_{}", i));
    }
    return names;
}

}  // namespace etendue
