// The commands of this program that a batch runs in processes of their own.
#pragma once

#include "batch/batch_options.h"
#include "batch/batch_units.h"
#include "process/child_process.h"
#include "session/image_outline.h"

#include <cstdint>
#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace etendue {

/// Holds what one line says that `etendue render --progress-fd` writes.
struct ChildProgress {
    std::string phase{};    ///< "load", "resume", "build", "render" or "write"
    double fraction = 0.0;  ///< part of the image that is done, [0, 1]
    double seconds = 0.0;   ///< seconds of rendering
    std::uint64_t samples = 0;
};
/// Reads a line of progress; none if `line` is no such JSON.
[[nodiscard]] std::optional<ChildProgress> parse_progress(const std::string& line);

/// Returns a path that no command line takes for an option.
[[nodiscard]] std::string as_argument(const std::filesystem::path& path);

/// The arguments of `etendue render` for one image, with all that the batch was told about how to render, and `threads`
/// threads, or one per processor if that is 0.
[[nodiscard]] std::vector<std::string> render_arguments(const BatchTask& task, const BatchOptions& options,
                                                        int threads);

/// Reads the names of a scene's variants and cameras by a process of its own. None if it cannot be read: rendering it
/// will say so.
[[nodiscard]] SceneNames find_names(const std::filesystem::path& scene, const BatchOptions& options);

/// Returns the options of `etendue view` that show an image as the PNG of the image with these `statistics` does.
[[nodiscard]] std::vector<std::string> display_arguments(const std::filesystem::path& statistics);

/// Holds what another process found out about an image that is to be rendered.
struct SceneLook {
    std::optional<double> seconds{};              ///< seconds that the image will take; none if nobody tried
    double start_seconds = 0.0;                   ///< part of `seconds` before the first sample
    std::optional<std::uint64_t> memory_bytes{};  ///< bytes that its process will need; none if nobody knows
    ImageOutline outline{};                       ///< outline of the image; empty if it was not found out
    std::string error{};                  ///< why the image cannot be rendered, of any number of lines; empty if it can
    std::vector<std::string> warnings{};  ///< what else is wrong with the scene; only `inspect_in_child` tells
};

/// Renders the beginning of the image, by `etendue render --probe`.
[[nodiscard]] SceneLook probe_in_child(const BatchTask& task, const BatchOptions& options);
/// Loads the scene of the image and renders nothing, by `etendue inspect`.
[[nodiscard]] SceneLook inspect_in_child(const BatchTask& task, const BatchOptions& options);

/// Says how a process has ended, as the end of a sentence.
[[nodiscard]] std::string end_in_words(const ChildEnd& end);

/// The message of a process that failed with these last lines: from the first that is an error on. Empty if none is.
[[nodiscard]] std::string error_of(const std::deque<std::string>& lines);

}  // namespace etendue
