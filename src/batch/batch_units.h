// The images that a batch is about: one for each scene, or for each of its frames, or variants, or frames of variants.
#pragma once

#include "batch/batch_options.h"
#include "session/image_job.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace etendue {

struct BatchTask {
    ImageJob job;
    std::filesystem::path render_output;  ///< path that `etendue render` is told to write: without the frame's number
    std::string id;                       ///< path of the image below the output directory, without its extension
    std::string scene_name{};             ///< path that the scene has below the directory that it was found in
};

struct BatchTasks {
    std::vector<BatchTask> chosen{};    ///< tasks to do, one scene after the other
    std::vector<BatchTask> left_out{};  ///< tasks that --only, --exclude or --failed leave out
};

/// Returns the name of the image without noise beside the image `output`.
[[nodiscard]] std::filesystem::path denoised_path(const std::filesystem::path& output);

/// The batch's own files in its directory `output`.
[[nodiscard]] std::vector<std::filesystem::path> batch_files(const std::filesystem::path& output);

/// Names what a scene offers that images can be made of.
struct SceneNames {
    std::vector<std::string> variants{};
    std::vector<std::string> cameras{};
    std::string shown_camera{};  ///< camera of the image where none is asked for; empty if there is none
};
/// Finds the names of the scene directory or file `scene`.
using FindNames = std::function<SceneNames(const std::filesystem::path& scene)>;

/// Throws UsageError that says why `pattern` cannot name images below the output directory, if it cannot.
void check_name_pattern(const std::string& pattern);

/// Collects the tasks. `find_names` is asked once for each scene if all variants or cameras are wanted, or if --name
/// asks for cameras. Throws UsageError if --only or --exclude names nothing, if they leave nothing, if --name leads out
/// of the output directory, or if the log is a file that the batch writes; SceneError if two files of the images or the
/// batch would have one name; and ReplacedInput if any of them, or the log, is an input of a scene.
[[nodiscard]] BatchTasks collect_tasks(const BatchOptions& options, const FindNames& find_names);

/// Returns a note that frames which are made at once each choose an exposure of their own; empty if no frame of `tasks`
/// gets a PNG without an exposure that is asked for.
[[nodiscard]] std::string note_on_exposures(std::span<const BatchTask> tasks, const SettingsOverrides& overrides);

/// Says why the image cannot be denoised, by its settings, however it is rendered; empty if it can, or if the settings
/// cannot be read.
[[nodiscard]] std::string why_not_denoised(const BatchTask& task, const BatchOptions& options);

}  // namespace etendue
