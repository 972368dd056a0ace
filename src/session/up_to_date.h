// Whether an image must be rendered again, and why.
#pragma once

#include "output/exr_driver.h"
#include "output/statistics.h"
#include "picture/output_paths.h"
#include "scene/scene_desc.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace etendue {

/// Why an image must be rendered.
struct Staleness {
    std::string reason;          ///< "never rendered"
    bool is_unfinished = false;  ///< there is no whole image, of whatever settings
    /// Part of the samples that an interrupted render has taken, or an image of which only more are asked for, [0, 1].
    double done = 0.0;
};

/// Returns why the files of `output` are no completed image: one is missing or damaged, or they are of a render that
/// was cut short; none if they are of a completed render.
[[nodiscard]] std::optional<Staleness> why_unfinished(const OutputPaths& output);

/// Returns whether `file` ends as a PNG does.
[[nodiscard]] bool is_whole_png(const std::filesystem::path& file);

/// Names of the layers and depths in files of their own that the statistics of `output` list, which lie beside the
/// image; none if there are no statistics.
[[nodiscard]] std::vector<std::string> listed_layer_files(const OutputPaths& output);

/// Returns the strategies image that the statistics of `output` list; nothing if they list none, or there are no
/// statistics.
[[nodiscard]] std::optional<StrategiesShown> listed_strategies_image(const OutputPaths& output);

/// Returns, without loading a scene, why the completed render `output` of the scene directory or file `scene` is
/// outdated by the inputs that the files of `output` list: one has another content now or is missing, or the inputs are
/// not known; none if all are as they were.
[[nodiscard]] std::optional<Staleness> why_outdated(const OutputPaths& output, const std::filesystem::path& scene);

/// Returns why the completed render `output`, whose inputs are as they were, is outdated by the `scene` that is loaded
/// from them now: the scene is read from more files, or its settings or `depth` have changed; none if neither. How many
/// samples are asked for and when the render is to end is compared with what the image has reached.
[[nodiscard]] std::optional<Staleness> why_outdated(const OutputPaths& output, const SceneDesc& scene,
                                                    PixelDepth depth);

/// Returns ": seed: 3 -> 4" if the files of the interrupted render `output` tell that a render with `settings` cannot
/// go on from its checkpoint; empty if they do not.
[[nodiscard]] std::string changes_of_sums(const OutputPaths& output, const RenderSettings& settings);

/// True if there is no reason of any kind; `path` is where `scene` was loaded from.
[[nodiscard]] bool is_up_to_date(const OutputPaths& output, const std::filesystem::path& path, const SceneDesc& scene,
                                 PixelDepth depth);

}  // namespace etendue
