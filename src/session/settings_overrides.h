// What the command line changes about a scene, shared by all commands that render.
#pragma once

#include "loader/loader.h"
#include "output/exr_driver.h"
#include "scene/scene_desc.h"
#include "scene/setting.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

enum class Quality {
    Draft,    ///< half the width and height, a sixteenth of the samples
    Preview,  ///< full size, a quarter of the samples
    Final,    ///< as the scene says
};

/// Holds the value of a setting with the option that gives it.
struct GivenSetting {
    SettingValue value;
    std::string option;
};

/// Stand in place of the file of an environment: no light from afar, and white of radiance 1 from everywhere.
inline constexpr std::string_view kNoEnvironment = "none";
inline constexpr std::string_view kNeutralEnvironment = "neutral";

struct SettingsOverrides {
    std::optional<Quality> quality;
    std::map<std::string, GivenSetting, std::less<>> given;  ///< by JSON pointers; layers are those to add
    bool deep = false;
    std::optional<std::string> environment;     ///< a file, or one of the words above
    std::vector<std::filesystem::path> assets;  ///< as in LoadOptions
    std::optional<int> frame;                   ///< frame of the sequence that is shown
    PixelDepth depth = PixelDepth::Half;
    bool png = true;  ///< a preview is written beside the image

    /// Takes `option` of the table of settings as it stands on a command line, with `text` behind it unless it is a
    /// flag. Throws UsageError that names the option if the text is not what the setting takes.
    void give(std::string_view option, const std::string& text = {});

    /// True if the setting with this JSON pointer is given.
    [[nodiscard]] bool has(std::string_view pointer) const { return given.contains(pointer); }

    /// Returns the samples per pixel if they are given.
    [[nodiscard]] std::optional<std::uint32_t> spp() const;

    /// Returns the frames of the sequence if they are given.
    [[nodiscard]] std::optional<FrameRange> frames() const;

    /// Applies quality first, then everything that was stated explicitly. Throws SceneError if --float is asked of an
    /// ACES container.
    void apply(RenderSettings& settings) const;

    /// Returns the file of the environment if one is given.
    [[nodiscard]] std::optional<std::filesystem::path> environment_file() const;

    /// Puts the given environment in place of the scene's. Throws SceneError if the studio is given, too.
    void apply_environment(SceneDesc& scene) const;

    /// Says how to load a scene for these.
    [[nodiscard]] LoadOptions load_options() const;
};

}  // namespace etendue
