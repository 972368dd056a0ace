// From a scene directory or file to a SceneDesc.
#pragma once

#include "core/error.h"
#include "scene/scene_desc.h"
#include "scene/swept_space.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

/// Says how a scene is loaded where that is not as its render.json says.
struct LoadOptions {
    std::optional<int> frame{};  ///< frame of a sequence, shown at time_code (0 if none) + frame / fps
    /// Changes the settings, once they are read and before anything else is.
    std::function<void(RenderSettings&)> adjust{};
    /// The text of another render.json, merged into the scene's as RFC 7386 says: members replace members, objects are
    /// merged, null removes. Problems of it are located in kGivenSettings where the scene has no render.json.
    std::string settings{};
    /// Directories outside of the scene's from which the environment image that its settings name may come.
    std::vector<std::filesystem::path> assets{};
    /// Animations that are not shown are read too, and warnings say what is wrong with them; for `inspect`.
    bool every_animation = false;
};

/// Stands in messages for settings that no file holds.
inline constexpr const char* kGivenSettings = "(settings)";

/// Reads one scene file format.
///
/// To add another, see CONTRIBUTING.md (A scene format).
class SceneLoader {
  public:
    virtual ~SceneLoader() = default;

    /// True if `file` is of this format, judged by its name and first bytes; false says "not my format", never
    /// "broken".
    [[nodiscard]] virtual bool can_load(const std::filesystem::path& file) const = 0;

    /// Fills `scene`, which has its settings, from `file` at the moment that these show. Every problem goes to
    /// `problems`; when nothing useful can follow, throws SceneError with those that are not in `problems` yet. Returns
    /// the space of the whole animation for a frame of a sequence that lacks a camera or light, else an empty one.
    virtual SweptSpace load(const std::filesystem::path& file, const LoadOptions& options, SceneDesc& scene,
                            ProblemList& problems) const = 0;
};

/// All loaders, in the order in which they are asked.
[[nodiscard]] std::span<const std::unique_ptr<const SceneLoader>> scene_loaders();

struct LoadedScene {
    SceneDesc scene;
    ProblemList problems;  ///< notes and warnings; errors have been thrown
    SweptSpace swept{};    ///< as SceneLoader::load returns it
};

/// Loads the scene directory or file `path`: its scene file, then render.json beside it if there is one, then
/// validates. What `options` leave open is as render.json says. Throws SceneError with all problems if any is an error.
[[nodiscard]] LoadedScene load_scene(const std::filesystem::path& path, const LoadOptions& options = {});

/// Loads the scene directory or file `path` as `load_scene` does, for `inspect`: every problem is returned, none is
/// thrown.
[[nodiscard]] LoadedScene inspect_scene(const std::filesystem::path& path, const LoadOptions& options = {});

/// Names the file that says how a scene directory is rendered.
inline constexpr std::string_view kSettingsName = "render.json";

/// Returns the name that a user would give the scene directory or file `path`, also for "." and "scenes/box/".
[[nodiscard]] std::string scene_name(const std::filesystem::path& path);

/// Reads the settings of the render.json of the scene directory or file `path`; none if there is none, or if it cannot
/// be read, which loading the scene will say.
[[nodiscard]] std::optional<RenderSettings> find_settings(const std::filesystem::path& path);

/// The frames that these settings ask for; none if they ask for none.
[[nodiscard]] std::optional<FrameRange> find_frames(const std::filesystem::path& path);

/// Returns every file that the scene directory or file `path` may be read from: scene files, render.json and what their
/// JSON names, beside them or in the directories `assets`. These files need not exist. Only JSON is read, and JSON that
/// cannot be read is left out.
[[nodiscard]] std::vector<std::filesystem::path> find_inputs(const std::filesystem::path& path,
                                                             std::span<const std::filesystem::path> assets = {});

/// Every scene directory at or below `root`, sorted by path: a directory that holds a render.json or glTF files, also
/// inside another one. Loading says of those with several files that one must be named. Links to directories are
/// followed, but for those in a scene directory and those that lead up. What cannot be read is among them, so that
/// loading it says why. Throws SceneError if `root` is no directory.
[[nodiscard]] std::vector<std::filesystem::path> find_scene_directories(const std::filesystem::path& root);

}  // namespace etendue
