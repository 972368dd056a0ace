// The room that a scene takes, in all moments of its animation.
#pragma once

#include "core/bounds.h"
#include "scene/scene_desc.h"

#include <limits>

namespace etendue {

/// Holds what the camera and the ground of a scene that brings none are placed for, from the scene's origin.
struct SweptSpace {
    Bounds bounds{};
    float lowest = std::numeric_limits<float>::infinity();  ///< height of the lowest vertex

    /// Takes in all that `scene` shows.
    void extend(const SceneDesc& scene);
};

/// Does what the other of this name does for a scene whose animation fills `swept`, so that camera and ground stand
/// still; an empty one is that of the scene as it is.
void add_missing_camera_and_light(SceneDesc& scene, const SweptSpace& swept, ProblemList& problems);

}  // namespace etendue
