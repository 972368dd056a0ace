// One scene, from its directory to its files: the data flow of the program in one function.
#pragma once

#include "core/parallel.h"
#include "output/statistics.h"
#include "picture/sample_ranges.h"
#include "session/prepared_scene.h"
#include "session/render_watcher.h"
#include "session/settings_overrides.h"
#include "session/strategies_image.h"

#include <atomic>
#include <exception>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace etendue {

struct SceneRenderRequest {
    std::filesystem::path scene{};  ///< scene directory or file, for messages
    /// The EXR; PNG and JSON stand beside it under the same name. Empty for NAME.exr here. Or a .partial, which holds
    /// the sums of a part of the image, to be merged with others.
    std::filesystem::path output{};
    std::optional<int> first_frame{};  ///< number of the first frame of the image's sequence, in which `auto` chooses
    StrategiesRequest strategies{};
    SettingsOverrides overrides{};
    std::optional<SampleRange> samples{};     ///< samples of a part; all without it
    double checkpoint_minutes = 0.0;          ///< between checkpoints; 0 for none but when interrupted
    bool resume = false;                      ///< go on with the checkpoint, if there is one, or with the part
    std::optional<double> keep_sums_after{};  ///< seconds that a render takes whose sums are kept; none for never
    bool force = false;                       ///< render again what was rendered before; a checkpoint is gone on with
    int progress_descriptor = -1;             ///< pipe that progress is written to as JSON; -1 for a bar on stderr
    bool quiet = false;
    std::string title{};    ///< before the progress bar
    std::string command{};  ///< the command line, to be told with the image
    /// Becomes true when the image is another's to make: nothing is written any more then. Null if it never does.
    const std::atomic<bool>* is_lost = nullptr;
    std::vector<RenderWatcher*> watchers{};  ///< look on, and outlive the render
    /// Holds what was told of earlier images and is not told again; null tells all.
    std::set<std::string>* told = nullptr;
};

/// Thrown by a render whose image has become another's to make.
class LostRender : public std::exception {
  public:
    [[nodiscard]] const char* what() const noexcept override { return "another process makes the image"; }
};

struct SceneRenderResult {
    RenderStatistics statistics{};  ///< statistics; for a part that was there, those of its own render
    std::filesystem::path output{};
    bool interrupted = false;
    bool was_there = false;  ///< the part had been rendered before
};

/// Compiles, renders and writes. When it is interrupted, the checkpoint is written, too, and the image marked
/// incomplete; checkpoints are removed once the image is complete. Notes and warnings go to stderr unless `quiet`.
/// Throws SceneError for what is wrong with the scene or its settings, or for a checkpoint or part of another render,
/// IoError when a file cannot be written, LostRender when the image is lost.
[[nodiscard]] SceneRenderResult render_scene(PreparedScene prepared, const SceneRenderRequest& request,
                                             const ThreadPool& threads);

}  // namespace etendue
