// Notes of lamps that are likely not what whoever exported them meant.
#pragma once

#include "loader/settings/light_override.h"
#include "scene/scene_desc.h"

#include <map>
#include <string>

namespace etendue {

/// Notes lamps of the file that bring hundreds of times the light that shows white: watts that were exported as lumens,
/// most likely. Says nothing where units, exposure or a lamp's strength have been set, `changes` being those of lamps.
void note_bright_lamps(const std::map<std::string, LightOverride>& changes, const SceneDesc& scene,
                       ProblemList& problems);

/// Notes empty nodes that have the name of Blender's area lamps, which glTF has no light for, unless one of `changes`
/// is about them.
void note_area_lamps(const std::map<std::string, LightOverride>& changes, const SceneDesc& scene,
                     ProblemList& problems);

}  // namespace etendue
