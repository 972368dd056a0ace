#include "loader/gltf/gltf_extras.h"

#include "loader/json_text.h"

#include <algorithm>
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

/// Adds to `scene` what `extras` say of the thing `name`.
void add(const GltfDocument& document, const GltfExtras& extras, ExtrasDesc::Of of, const std::string& name,
         SceneDesc& scene) {
    scene.extras.push_back({of, name, extras.json, document.at(extras.pointer)});
}

void read_extras_of_node(const GltfDocument& document, const GltfExtras& extras, SceneDesc& scene) {
    const auto found = std::ranges::find(scene.nodes, static_cast<std::uint32_t>(extras.index), &NodeDesc::number);
    if (found == scene.nodes.end()) return;
    const CameraDesc* camera = nullptr;
    for (const CameraDesc& each : scene.cameras)
        if (!found->name.empty() && each.node == found->name) camera = &each;
    if (camera != nullptr)
        add(document, extras, ExtrasDesc::Of::Camera, camera->name, scene);
    else
        add(document, extras, ExtrasDesc::Of::Node, found->name, scene);
}

}  // namespace

void take_extras(const nlohmann::json& document, GltfDocument& result) {
    take_from(member_of(&document, "materials"), "/materials", ExtrasDesc::Of::Material, result);
    take_from(member_of(&document, "nodes"), "/nodes", ExtrasDesc::Of::Node, result);
    take_from(member_of(&document, "cameras"), "/cameras", ExtrasDesc::Of::Camera, result);
    const nlohmann::json* punctual = member_of(member_of(&document, "extensions"), "KHR_lights_punctual");
    take_from(member_of(punctual, "lights"), "/extensions/KHR_lights_punctual/lights", ExtrasDesc::Of::Light, result);
}

void read_extras(const GltfDocument& document, SceneDesc& scene) {
    // What is said of one node comes after what is said of all that share its data.
    for (const GltfExtras& extras : document.extras) {
        if (extras.of == ExtrasDesc::Of::Node) continue;
        const std::string thing = extras.pointer.substr(0, extras.pointer.rfind("/extras/"));
        if (extras.of == ExtrasDesc::Of::Material && extras.index < scene.materials.size())
            add(document, extras, ExtrasDesc::Of::Material, scene.materials[extras.index].name, scene);
        if (extras.of == ExtrasDesc::Of::Camera)
            for (const CameraDesc& camera : scene.cameras)
                if (camera.location.pointer == thing) add(document, extras, ExtrasDesc::Of::Camera, camera.name, scene);
        if (extras.of == ExtrasDesc::Of::Light)
            for (const LightDesc& light : scene.lights)
                if (light.location.pointer == thing) add(document, extras, ExtrasDesc::Of::Light, light.name, scene);
    }
    for (const GltfExtras& extras : document.extras)
        if (extras.of == ExtrasDesc::Of::Node) read_extras_of_node(document, extras, scene);
}

}  // namespace etendue
