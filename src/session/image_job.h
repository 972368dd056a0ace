// The images that a scene asks for, one or a sequence of frames, and rendering those that are not up to date.
#pragma once

#include "core/parallel.h"
#include "session/scene_render.h"
#include "session/settings_overrides.h"

#include <atomic>
#include <filesystem>
#include <optional>
#include <set>
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

/// The jobs of one scene: `output` itself, or one for each frame that `overrides` or the scene's render.json ask for.
[[nodiscard]] std::vector<ImageJob> image_jobs(const std::filesystem::path& scene, const std::filesystem::path& output,
                                               const std::string& name, const SettingsOverrides& overrides);

/// Returns `overrides` with the frame, variant and camera of the job.
[[nodiscard]] SettingsOverrides overrides_of(const ImageJob& job, SettingsOverrides overrides);

struct ImageJobOptions {
    SettingsOverrides overrides;
    bool force = false;  ///< also what is up to date
    bool quiet = false;
    bool make_directories = false;               ///< for the output
    double checkpoint_minutes = 0.0;             ///< as in SceneRenderRequest
    bool resume = false;                         ///< the same
    std::optional<double> keep_sums_after{};     ///< the same
    int progress_descriptor = -1;                ///< the same
    StrategiesRequest strategies{};              ///< the same
    std::optional<SampleRange> samples{};        ///< the same
    std::string title{};                         ///< before the progress bar
    std::string command{};                       ///< as in SceneRenderRequest
    const std::atomic<bool>* is_lost = nullptr;  ///< as in SceneRenderRequest
    std::vector<RenderWatcher*> watchers{};      ///< the same
    std::set<std::string>* told = nullptr;       ///< the same
};

/// Renders the image unless it is up to date. Throws what `prepare_scene` and `render_scene` throw.
[[nodiscard]] ImageResult run_job(const ImageJob& job, const ImageJobOptions& options, const ThreadPool& threads);

/// A JSON array with one object for each image.
[[nodiscard]] std::string to_json(std::span<const ImageResult> results);

}  // namespace etendue
