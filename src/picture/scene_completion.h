// A loaded scene, made ready to be compiled.
#pragma once

#include "core/error.h"
#include "scene/scene_desc.h"
#include "scene/swept_space.h"

#include <optional>
#include <string>

namespace etendue {

/// Adds a camera and a light where `scene`, whose animation fills `swept`, has none, and applies the variant of its
/// materials; `problems` notes what was added. Throws SceneError for what `validate` finds, and for integrators that do
/// not see shadow catchers and holdouts.
void complete_scene(SceneDesc& scene, const SweptSpace& swept, ProblemList& problems);

/// Returns the name of a material in whose place the camera sees a shadow or a hole, or nothing if there is none.
[[nodiscard]] std::optional<std::string> replaced_material(const SceneDesc& scene);

/// Returns why `integrator` cannot show a shadow or a hole in the place of `material`, or nothing if it can.
[[nodiscard]] std::optional<std::string> misses_alpha(const std::string& integrator, const std::string& material);

}  // namespace etendue
