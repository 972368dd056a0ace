// What a scene file's extras say, merged into what render.json says.
#pragma once

#include "loader/settings/render_json.h"

namespace etendue {

/// Returns `json` with what the extras of `scene` say of it, its materials, lights and cameras beside it; what `json`
/// says goes first, key by key. Nothing in extras is an error: what cannot be used is a warning.
[[nodiscard]] RenderJson with_extras(RenderJson json, const SceneDesc& scene, ProblemList& problems);

}  // namespace etendue
