#include "session/image_outline.h"

#include "picture/render_setup.h"
#include "scene/canonical_settings.h"

namespace etendue {

ImageOutline outline_of(const SceneDesc& scene) {
    const RenderSettings& settings = scene.settings;
    const PixelRect window = make_render_options(settings).window;
    ImageOutline outline{.width = window.width(),
                         .height = window.height(),
                         .spp = settings.spp,
                         .integrator = settings.integrator.type};
    const CameraDesc* camera = scene.cameras.empty() ? nullptr : &scene.cameras.front();
    if (!settings.camera.empty()) camera = find_camera(scene, settings.camera);
    if (camera != nullptr) outline.camera = camera->name.empty() ? camera->node : camera->name;
    return outline;
}

std::string resolved_settings(const RenderSettings& settings) {
    return to_json_object(setting_texts(settings));
}

}  // namespace etendue
