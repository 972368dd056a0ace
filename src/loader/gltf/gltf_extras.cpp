#include "loader/gltf/gltf_extras.h"

#include "loader/json_text.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <utility>

#include <nlohmann/json.hpp>

namespace etendue {

namespace {

constexpr const char* kExtrasKey = "etendue";

/// Returns the member `key` of `object`, null if there is none or `object` is no object.
const nlohmann::json* member_of(const nlohmann::json* object, const char* key) {
    if (object == nullptr || !object->is_object()) return nullptr;
    const auto found = object->find(key);
    return found == object->end() ? nullptr : &*found;
}

void take_from(const nlohmann::json* things, const std::string& pointer, ExtrasDesc::Of of, GltfDocument& result) {
    if (things == nullptr || !things->is_array()) return;
    for (std::size_t i = 0; i < things->size(); ++i) {
        const nlohmann::json* extras = member_of(member_of(&(*things)[i], "extras"), kExtrasKey);
        if (extras == nullptr) continue;
        result.extras.push_back(
            {of, i, extras->dump(), child_pointer(child_pointer(child_pointer(pointer, i), "extras"), kExtrasKey)});
    }
}

/// Returns whether the extras of the glTF object `thing` contain settings of Etendue.
bool has_settings(const nlohmann::json* thing) {
    return member_of(member_of(thing, "extras"), kExtrasKey) != nullptr;
}

/// Warns once if the extras of `things` contain settings, which are not read there.
void warn_of_unread(const nlohmann::json* things, const std::string& pointer, const GltfDocument& result,
                    ProblemList& problems) {
    if (things == nullptr) return;
    const auto warn = [&](const std::string& thing) {
        problems.warning(result.at(child_pointer(child_pointer(thing, "extras"), kExtrasKey)),
                         "is not read here: it belongs in the extras of a scene, a node, a material, a camera or a "
                         "light");
    };
    if (has_settings(things)) return warn(pointer);
    if (!things->is_array()) return;
    for (std::size_t i = 0; i < things->size(); ++i)
        if (has_settings(&(*things)[i])) return warn(child_pointer(pointer, i));
}

/// Bounds the bytes of all extras: any number of places may share what is said of a camera or a light.
constexpr std::size_t kMostExtrasBytes = std::size_t{64} << 20;

/// Gives a scene the extras of its document.
class ExtrasReader {
  public:
    ExtrasReader(const GltfDocument& document, SceneDesc& scene) : document_(document), scene_(scene) {
        for (std::size_t i = 0; i < scene.nodes.size(); ++i) node_by_number_.emplace(scene.nodes[i].number, i);
        for (const CameraDesc& camera : scene.cameras)
            if (!camera.node.empty()) camera_of_node_[camera.node] = camera.name;
    }

    /// Adds what `extras` say of the thing `name`, unless that would be too much.
    void add(const GltfExtras& extras, ExtrasDesc::Of of, const std::string& name) {
        bytes_ += extras.json.size();
        if (bytes_ > kMostExtrasBytes)
            throw SceneError(document_.at(extras.pointer), "what extras say of all places takes more than 64 MiB");
        scene_.extras.push_back({of, name, extras.json, document_.at(extras.pointer)});
    }
    void add_of_node(const GltfExtras& extras) {
        const auto found = node_by_number_.find(static_cast<std::uint32_t>(extras.index));
        if (found == node_by_number_.end()) return;
        const std::string& node = scene_.nodes[found->second].name;
        if (const auto camera = camera_of_node_.find(node); camera != camera_of_node_.end())
            add(extras, ExtrasDesc::Of::Camera, camera->second);
        else
            add(extras, ExtrasDesc::Of::Node, node);
    }

  private:
    const GltfDocument& document_;
    SceneDesc& scene_;
    std::size_t bytes_ = 0;
    std::unordered_map<std::uint32_t, std::size_t> node_by_number_;
    std::unordered_map<std::string, std::string> camera_of_node_;
};

}  // namespace

void take_extras(const nlohmann::json& document, GltfDocument& result, ProblemList& problems) {
    warn_of_unread(&document, "", result, problems);
    for (const char* key : {"accessors", "animations", "asset", "buffers", "bufferViews", "images", "meshes",
                            "samplers", "skins", "textures"})
        warn_of_unread(member_of(&document, key), child_pointer("", key), result, problems);
    take_from(member_of(&document, "scenes"), "/scenes", ExtrasDesc::Of::Scene, result);
    take_from(member_of(&document, "materials"), "/materials", ExtrasDesc::Of::Material, result);
    take_from(member_of(&document, "nodes"), "/nodes", ExtrasDesc::Of::Node, result);
    take_from(member_of(&document, "cameras"), "/cameras", ExtrasDesc::Of::Camera, result);
    const nlohmann::json* punctual = member_of(member_of(&document, "extensions"), "KHR_lights_punctual");
    take_from(member_of(punctual, "lights"), "/extensions/KHR_lights_punctual/lights", ExtrasDesc::Of::Light, result);
}

void read_extras(const GltfDocument& document, SceneDesc& scene) {
    ExtrasReader reader(document, scene);
    // Settings of the scene come first, then those of data that nodes share, then those of single nodes.
    for (const GltfExtras& extras : document.extras) {
        if (extras.of == ExtrasDesc::Of::Node) continue;
        const std::string thing = extras.pointer.substr(0, extras.pointer.rfind("/extras/"));
        if (extras.of == ExtrasDesc::Of::Material && extras.index < scene.materials.size())
            reader.add(extras, ExtrasDesc::Of::Material, scene.materials[extras.index].name);
        if (extras.of == ExtrasDesc::Of::Scene && extras.index == scene.shown_scene)
            reader.add(extras, ExtrasDesc::Of::Scene, {});
        if (extras.of == ExtrasDesc::Of::Camera)
            for (const CameraDesc& camera : scene.cameras)
                if (camera.location.pointer == thing) reader.add(extras, ExtrasDesc::Of::Camera, camera.name);
        if (extras.of == ExtrasDesc::Of::Light)
            for (const LightDesc& light : scene.lights)
                if (light.location.pointer == thing) reader.add(extras, ExtrasDesc::Of::Light, light.name);
    }
    for (const GltfExtras& extras : document.extras)
        if (extras.of == ExtrasDesc::Of::Node) reader.add_of_node(extras);
}

}  // namespace etendue
