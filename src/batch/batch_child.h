// The commands of this program that a batch runs in processes of their own.
#pragma once

#include "batch/batch_options.h"
#include "batch/batch_units.h"
#include "process/child_process.h"

#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace etendue {

/// Holds what one line says that `etendue render --progress-fd` writes.
struct ChildProgress {
    std::string phase{};    ///< "load", "resume", "build", "render" or "write"
    double fraction = 0.0;  ///< share of the samples that are taken, [0, 1]
    double seconds = 0.0;   ///< seconds of rendering
};
/// Reads a line of progress; none if `line` is no such JSON.
[[nodiscard]] std::optional<ChildProgress> parse_progress(const std::string& line);

/// The arguments of `etendue render` for one image, with all that the batch was told about how to render.
[[nodiscard]] std::vector<std::string> render_arguments(const BatchTask& task, const BatchOptions& options);

/// The names of the scene's variants, read by a process of its own. None if it cannot be read: rendering it will say
/// so.
[[nodiscard]] std::vector<std::string> find_variants(const std::filesystem::path& scene, const BatchOptions& options);

/// Seconds that the image will take, by `etendue render --probe`. None if the probe fails: rendering will say why.
[[nodiscard]] std::optional<double> probe_in_child(const BatchTask& task, const BatchOptions& options);

/// The message of a process that failed with these last lines: from the first that is an error on. Empty if none is.
[[nodiscard]] std::string error_of(const std::deque<std::string>& lines);

}  // namespace etendue
