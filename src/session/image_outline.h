// What one line can tell of an image before it is rendered.
#pragma once

#include "scene/scene_desc.h"

#include <string>

namespace etendue {

struct ImageOutline {
    int width = 0;  ///< pixels that are rendered; 0 if nothing is known of the image
    int height = 0;
    int spp = 0;
    std::string integrator{};
    std::string camera{};  ///< name of the camera, or of its node; empty if neither has one
};

/// Outlines the image of a scene that has a camera. Throws SceneError if its settings contradict each other.
[[nodiscard]] ImageOutline outline_of(const SceneDesc& scene);

/// Returns all settings, defaults and options included, as a JSON object by their JSON pointers.
[[nodiscard]] std::string resolved_settings(const RenderSettings& settings);

}  // namespace etendue
