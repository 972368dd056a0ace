// The images that a scene asks for, one or a sequence of frames, and rendering those that are not up to date.
#pragma once

#include "core/parallel.h"
#include "session/scene_render.h"
#include "session/settings_overrides.h"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace etendue {

/// One image to make.
struct ImageJob {
    std::filesystem::path scene;
    std::filesystem::path output;  ///< the EXR
    std::string name;              ///< name in tables and progress
    std::optional<int> frame;      ///< frame of a sequence
    /// Names the variant of the scene's materials; none for the variant that overrides or render.json ask for.
    std::optional<std::string> variant{};
    /// Names the camera; none for the camera that overrides or render.json ask for.
    std::optional<std::string> camera{};
    std::optional<int> first_frame{};  ///< number of the first frame of the sequence
};

enum class ImageOutcome { Rendered, UpToDate, Failed, Interrupted };

struct ImageResult {
    ImageJob job;
    ImageOutcome outcome = ImageOutcome::Failed;
    std::string error;            ///< if it failed
    RenderStatistics statistics;  ///< if it was rendered
};

[[nodiscard]] const char* outcome_name(ImageOutcome outcome);

/// `output` with the frame's number of at least four digits in place of the last run of '#' in its name, or before its
/// extension: shot.exr is shot.0001.exr. A run of more than four '#' asks for as many digits.
[[nodiscard]] std::filesystem::path frame_path(const std::filesystem::path& output, int frame);

/// Returns the frames of the scene directory or file `scene` that `overrides` or its own settings ask for; none if they
/// ask for none, or for one moment.
[[nodiscard]] std::optional<FrameRange> frames_of(const std::filesystem::path& scene,
                                                  const SettingsOverrides& overrides);

/// The jobs of one scene: `output` itself, or one for each frame that `overrides` or the scene's render.json ask for.
[[nodiscard]] std::vector<ImageJob> image_jobs(const std::filesystem::path& scene, const std::filesystem::path& output,
                                               const std::string& name, const SettingsOverrides& overrides);

/// Returns `overrides` with the frame, variant and camera of the job.
[[nodiscard]] SettingsOverrides overrides_of(const ImageJob& job, SettingsOverrides overrides);

/// Renders the image of `job` as `request` asks, whose scene, output and frame are the job's. Unless it is forced, what
/// is up to date is left as it is. Throws what `prepare_scene` and `render_scene` throw.
[[nodiscard]] ImageResult run_job(const ImageJob& job, SceneRenderRequest request, const ThreadPool& threads);

/// A JSON array with one object for each image.
[[nodiscard]] std::string to_json(std::span<const ImageResult> results);

}  // namespace etendue
