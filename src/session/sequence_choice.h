// The integrator of a sequence for which none was asked.
#pragma once

#include "color/color_config.h"
#include "core/parallel.h"
#include "picture/integrator_choice.h"
#include "session/settings_overrides.h"

#include <filesystem>

namespace etendue {

/// Has a pilot choose the integrator in the frame `frame` of the scene directory or file `scene`, in place of `auto`,
/// for all frames of its sequence. Throws SceneError as prepare_scene does.
[[nodiscard]] IntegratorChoice choose_in_frame(const std::filesystem::path& scene, SettingsOverrides overrides,
                                               int frame, const ColorConfig& colors, const ThreadPool& threads);

}  // namespace etendue
