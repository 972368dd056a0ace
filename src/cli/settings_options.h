// The table of settings as options of a command.
#pragma once

#include "session/settings_overrides.h"

#include <array>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
class Validator;
}  // namespace CLI

namespace etendue {

/// Adds the options of all settings, and --quality, --environment, --assets, --deep, --half and --float. The values
/// arrive in `overrides`, which must outlive the command, when it is parsed.
void add_settings_options(CLI::App& command, SettingsOverrides& overrides);

/// Adds the options of the settings with these JSON pointers.
void add_settings_options(CLI::App& command, SettingsOverrides& overrides,
                          std::initializer_list<std::string_view> pointers);

/// Adds --no-png.
void add_png_option(CLI::App& command, SettingsOverrides& overrides);

/// Adds the argument of the scene, which must be given, and stores it in `scene`.
void add_scene_argument(CLI::App& command, std::string& scene);

/// Adds --assets DIR, which adds to `assets` before what $ETENDUE_ASSETS lists.
void add_assets_option(CLI::App& command, std::vector<std::filesystem::path>& assets);

/// Checks that an option's value is a number from `least` to `most`; NaN, which CLI::Range lets pass, is not.
[[nodiscard]] CLI::Validator real_range(double least, double most);

/// Turns "100,100,200,200" to x0, y0, x1, y1. Throws the error that CLI11 shows for `option` where --crop would not
/// take `text`.
[[nodiscard]] std::array<int, 4> parse_pixel_window(const std::string& option, const std::string& text);

}  // namespace etendue
