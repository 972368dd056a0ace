// A loaded scene, made ready to be compiled.
#pragma once

#include "core/error.h"
#include "scene/scene_desc.h"

namespace etendue {

/// Adds a camera and a light where `scene` has none, applies the variant of its materials, and has `path` render shadow
/// catchers unless an integrator is asked for; `problems` notes what was added and chosen. Throws SceneError for what
/// `validate` finds, and for integrators that do not see shadow catchers.
void complete_scene(SceneDesc& scene, ProblemList& problems);

}  // namespace etendue
