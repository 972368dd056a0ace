// What is said of samples that were not finite.
#pragma once

#include "integrator/integrator.h"
#include "scene/render_settings.h"
#include "session/settings_overrides.h"

#include <filesystem>
#include <string>

namespace etendue {

/// Warns, if samples were dropped, with a command that renders just the first of them. Light vertices of other
/// samples (--bdpt-connections cache:N) are not there then.
void report_dropped(const RenderCounters& counters, const std::filesystem::path& scene,
                    const SettingsOverrides& overrides, const RenderSettings& settings);

}  // namespace etendue
