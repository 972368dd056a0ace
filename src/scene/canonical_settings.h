// The settings of a render as exact texts, by which renders are told apart.
#pragma once

#include "scene/setting.h"

#include <map>
#include <string>
#include <vector>

namespace etendue {

/// Holds the value of each setting as JSON by its JSON pointer.
using SettingTexts = std::map<std::string, std::string>;

/// Returns all settings as they are.
[[nodiscard]] SettingTexts setting_texts(const RenderSettings& settings);

/// Returns the settings that `takes_part` is true for, exactly. Renders of the same image have the same texts: a
/// setting has its default if the one that it needs has, and a frame of a sequence is the moment that it shows.
[[nodiscard]] SettingTexts canonical_settings(const RenderSettings& settings, bool (*takes_part)(Decides decides));

/// Returns a line for each setting of which `after` has another text than `before`, as "integrator.light_samples: 1 ->
/// 3"; a setting that is missing has its default.
[[nodiscard]] std::vector<std::string> changed_settings(const SettingTexts& before, const SettingTexts& after);

/// Returns those of `texts` that are not the default.
[[nodiscard]] SettingTexts without_defaults(SettingTexts texts);

/// Returns `texts` as a JSON object in one line.
[[nodiscard]] std::string to_json_object(const SettingTexts& texts);

}  // namespace etendue
