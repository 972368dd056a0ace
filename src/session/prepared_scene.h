// A scene directory read and completed, before anything is made of it.
#pragma once

#include "core/error.h"
#include "output/statistics.h"
#include "scene/scene_desc.h"
#include "session/settings_overrides.h"

#include <filesystem>
#include <string>
#include <vector>

namespace etendue {

/// A scene as it will be rendered: loaded, overridden, completed and validated.
struct PreparedScene {
    SceneDesc scene;
    ProblemList problems;           ///< notes and warnings
    std::vector<InputFile> inputs;  ///< as they were before they were read, without content
    PhaseTime load;
};

/// Loads the scene directory or file `path` and applies overrides and defaults. Throws SceneError.
[[nodiscard]] PreparedScene prepare_scene(const std::filesystem::path& path, const SettingsOverrides& overrides);

/// Hashes every setting that the files of an image depend on, all bits of it, and the program's version: equal for
/// equal files as long as the input files are the same.
[[nodiscard]] std::string settings_hash(const SceneDesc& scene, PixelDepth depth);
/// Hashes the scene with other `settings` than its own.
[[nodiscard]] std::string settings_hash(const SceneDesc& scene, const RenderSettings& settings, PixelDepth depth);

/// Returns the settings that the hash is made of, but for defaults, as a JSON object by their JSON pointers.
[[nodiscard]] std::string requested_settings(const RenderSettings& settings);

}  // namespace etendue
