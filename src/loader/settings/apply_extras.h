// What a scene file's extras say, merged into what render.json says.
#pragma once

#include "loader/settings/render_json.h"

namespace etendue {

/// Returns `json` with the settings added that the extras of `scene` give the scene, its materials, lights and
/// cameras. Keys in `json` take precedence. Nothing in extras is an error: what cannot be used is a warning.
[[nodiscard]] RenderJson with_extras(RenderJson json, const SceneDesc& scene, ProblemList& problems);

}  // namespace etendue
