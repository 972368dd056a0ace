#include "scene/scene_desc.h"

#include <algorithm>
#include <set>

namespace etendue {

const CameraDesc* find_camera(const SceneDesc& scene, std::string_view name) {
    auto found = std::ranges::find(scene.cameras, name, &CameraDesc::name);
    if (found == scene.cameras.end()) found = std::ranges::find(scene.cameras, name, &CameraDesc::node);
    return found == scene.cameras.end() ? nullptr : &*found;
}

std::vector<std::string_view> camera_names(const SceneDesc& scene) {
    std::vector<std::string_view> names;
    for (const CameraDesc& camera : scene.cameras) {
        names.push_back(camera.name);
        if (!camera.node.empty() && camera.node != camera.name && find_camera(scene, camera.node) == &camera)
            names.push_back(camera.node);
    }
    return names;
}

std::vector<std::string_view> node_names_of_lights(const SceneDesc& scene) {
    std::set<std::string_view> own_names;
    for (const LightDesc& light : scene.lights) own_names.insert(light.name);
    std::vector<std::string_view> names;
    for (const LightDesc& light : scene.lights)
        names.push_back(own_names.contains(light.node) ? std::string_view() : std::string_view(light.node));
    return names;
}

}  // namespace etendue
