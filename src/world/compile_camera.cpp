#include "world/compile_parts.h"

#include <cmath>
#include <string>

namespace etendue {

namespace {

const CameraDesc& chosen_camera(const SceneDesc& scene) {
    if (scene.cameras.empty()) throw SceneError({scene.file.string(), ""}, "the scene has no camera");
    const std::string& name = scene.settings.camera;
    if (name.empty()) return scene.cameras.front();
    if (const CameraDesc* const camera = find_camera(scene, name)) return *camera;
    throw SceneError(scene.settings.at("/camera"),
                     "there is no camera '" + name + "'; " + name_hint(name, camera_names(scene)));
}

}  // namespace

TransformMotion compile_camera_motion(const SceneDesc& scene) {
    return chosen_camera(scene).motion;
}

Camera compile_camera(const SceneDesc& scene) {
    const CameraDesc& desc = chosen_camera(scene);
    const FilmSettings& film = scene.settings.film;
    const float aspect = static_cast<float>(film.width) / static_cast<float>(film.height);
    const CameraPose pose = CameraPose::from_matrix(desc.to_world);
    if (desc.type == CameraType::Orthographic) return OrthographicCamera{pose, desc.ymag * aspect, desc.ymag};
    const float half_height = std::tan(0.5f * desc.yfov);
    const PinholeCamera pinhole{pose, half_height * aspect, half_height};
    if (desc.lens_radius > 0.0f) return ThinLensCamera{pinhole, desc.lens_radius, desc.focus_distance};
    return pinhole;
}

}  // namespace etendue
