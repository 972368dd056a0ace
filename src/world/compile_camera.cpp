#include "world/compile_parts.h"

#include <algorithm>
#include <cmath>
#include <optional>
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

/// Turns the camera as `place` says, whose numbers are of a world in which the scene's own origin is `origin`.
CameraPose to_pose(const CameraPlace& place, const Vec3d& origin) {
    const Vec3d forward = (place.target - place.eye).normalized();
    const Vec3d right = forward.cross(place.up).normalized();
    return {.position = Vec3f(place.eye - origin),
            .right = Vec3f(right),
            .up = Vec3f(right.cross(forward)),
            .forward = Vec3f(forward)};
}

}  // namespace

TransformMotion compile_camera_motion(const SceneDesc& scene) {
    return scene.settings.camera_place ? TransformMotion() : chosen_camera(scene).motion;
}

Camera compile_camera(const SceneDesc& scene) {
    const CameraDesc& desc = chosen_camera(scene);
    const std::optional<CameraPlace>& place = scene.settings.camera_place;
    const CameraPose pose = place ? to_pose(*place, scene.origin) : CameraPose::from_matrix(desc.to_world);
    const ClipRange clip{desc.clip.start, desc.clip.end};
    if (desc.type == CameraType::Equirectangular) return EquirectangularCamera{pose, clip};
    const float aspect = scene.settings.film.aspect();
    if (desc.type == CameraType::Fisheye) {
        const float height = 1.0f / (desc.circle * std::min(1.0f, aspect));
        const float width = height * aspect;
        return FisheyeCamera{
            .pose = pose,
            .half_width = width,
            .half_height = height,
            .center = desc.shift * (2.0f * std::max(width, height)),
            .half_angle = 0.5f * desc.fov,
            .mapping = desc.fisheye == FisheyeType::Equisolid ? FisheyeMapping::Equisolid : FisheyeMapping::Equidistant,
            .clip = clip};
    }
    const float half_height = desc.type == CameraType::Orthographic ? desc.ymag : std::tan(0.5f * desc.yfov);
    const float half_width = half_height * aspect;
    const Vec2f center = desc.shift * (2.0f * std::max(half_width, half_height));
    if (desc.type == CameraType::Orthographic) return OrthographicCamera{pose, half_width, half_height, center, clip};
    const PinholeCamera pinhole{pose, half_width, half_height, center, clip};
    if (!(desc.lens_radius > 0.0f)) return pinhole;
    const ApertureDesc& opening = desc.aperture;
    return ThinLensCamera{
        pinhole, desc.lens_radius, desc.focus_distance, {opening.blades, opening.rotation, opening.ratio}};
}

}  // namespace etendue
