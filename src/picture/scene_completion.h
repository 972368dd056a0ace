// A loaded scene, made ready to be compiled.
#pragma once

#include "core/error.h"
#include "scene/scene_desc.h"

namespace etendue {

/// Adds a camera and a light where `scene` has none, which `problems` notes, and applies the variant of its materials.
/// Throws SceneError for what `validate` finds.
void complete_scene(SceneDesc& scene, ProblemList& problems);

}  // namespace etendue
