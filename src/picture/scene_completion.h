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
/// not see shadow catchers.
void complete_scene(SceneDesc& scene, const SweptSpace& swept, ProblemList& problems);

/// Returns the name of a material that catches shadows, or nothing if none does.
[[nodiscard]] std::optional<std::string> shadow_catcher(const SceneDesc& scene);

/// Returns why `integrator` cannot show the shadows that the material `catcher` catches, or nothing if it can.
[[nodiscard]] std::optional<std::string> misses_shadows(const std::string& integrator, const std::string& catcher);

}  // namespace etendue
