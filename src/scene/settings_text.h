// The settings as text.
#pragma once

#include "scene/render_settings.h"

#include <string>

namespace etendue {

/// Their lines of the text of a scene, which are its last.
[[nodiscard]] std::string dump(const RenderSettings& settings);

}  // namespace etendue
