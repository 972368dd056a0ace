// The names that expressions and layers have for lights.
#pragma once

#include "lightpath/automaton.h"
#include "scene/scene_desc.h"

#include <set>
#include <string>
#include <vector>

namespace etendue {

/// Returns the names that expressions have for the materials and lights of `scene`.
[[nodiscard]] PathNames path_names(const SceneDesc& scene);

/// Returns the names of what shines, each once, in the order of the scene.
[[nodiscard]] std::vector<std::string> light_names(const SceneDesc& scene);

/// Returns `name` with '_' in place of each character that layers may not be called by; not too long for a file, and
/// unlike what is in `taken`, where it is put.
[[nodiscard]] std::string layer_name(const std::string& name, std::set<std::string>& taken);

/// Returns the expression of the light that comes from what has a name that matches `pattern`. In a pattern, both kinds
/// of quotes would end it: then * stands for them.
[[nodiscard]] std::string light_expression(std::string pattern);

}  // namespace etendue
