// A scene built by hand in which nothing is wrong.
#pragma once

#include "scene/scene_desc.h"

namespace etendue {

/// One triangle with a textured material, one instance, one camera, one spot light, an environment.
[[nodiscard]] SceneDesc small_scene();

}  // namespace etendue
