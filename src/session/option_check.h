// Mistakes on a command line that no scene can make good.
#pragma once

#include "session/settings_overrides.h"

namespace etendue {

/// Throws UsageError if an option names a layer or a colour space that no scene has, or contradicts another. What
/// depends on the scene is not looked at.
void check_options(const SettingsOverrides& overrides);

}  // namespace etendue
