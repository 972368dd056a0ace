// What render.json says of lamps, applied to those of a scene, and the lamps that it adds.
#pragma once

#include "loader/settings/render_json.h"

#include <map>
#include <string>

namespace etendue {

/// Changes the lamps of `scene` by their own names and by those of their nodes, takes others in place of them, and adds
/// lamps. Errors for names that the scene does not have, and for what its lamps cannot be.
void apply_lights(const std::map<std::string, LightOverride>& changes, SceneDesc& scene, ProblemList& problems);

}  // namespace etendue
