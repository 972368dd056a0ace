// The table of settings as options of a command.
#pragma once

#include "core/pixel_rect.h"
#include "session/settings_overrides.h"

#include <string>

namespace CLI {
class App;
class Validator;
}  // namespace CLI

namespace etendue {

/// Adds the options of all settings, and --quality, --environment, --assets, --deep, --half and --float. The values
/// arrive in `overrides`, which must outlive the command, when it is parsed.
void add_settings_options(CLI::App& command, SettingsOverrides& overrides);

/// Adds --no-png.
void add_png_option(CLI::App& command, SettingsOverrides& overrides);

/// Adds the argument of the scene, which must be given, and stores it in `scene`.
void add_scene_argument(CLI::App& command, std::string& scene);

/// Checks that an option's value is a number from `least` to `most`; NaN, which CLI::Range lets pass, is not.
[[nodiscard]] CLI::Validator real_range(double least, double most);

/// Reads x0, y0, x1 and y1 from "100,100,200,200". Throws the error that CLI11 shows for `option` where --crop would
/// not take `text`.
[[nodiscard]] PixelRect parse_pixel_window(const std::string& option, const std::string& text);

}  // namespace etendue
