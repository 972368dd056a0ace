// Whether an image must be rendered again, and why.
#pragma once

#include "app/output_paths.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace etendue {

/// Why an image must be rendered.
struct Staleness {
    std::string reason;          ///< "never rendered"
    bool is_unfinished = false;  ///< there is no whole image, of whatever settings
    double done = 0.0;           ///< part of its samples that an interrupted render has taken, [0, 1]
};

/// What the three files of `output` themselves say: one is missing, or they are of a render that was cut short. None if
/// they are of one that was completed.
[[nodiscard]] std::optional<Staleness> why_unfinished(const OutputPaths& output);

/// Of a completed render, what its inputs and settings say: it must be newer than every file in `inputs`, and made with
/// the settings whose hash is `hash`. None if it is.
[[nodiscard]] std::optional<Staleness> why_outdated(const OutputPaths& output,
                                                    const std::vector<std::filesystem::path>& inputs,
                                                    const std::string& hash);

/// True if there is no reason of either kind.
[[nodiscard]] bool is_up_to_date(const OutputPaths& output, const std::vector<std::filesystem::path>& inputs,
                                 const std::string& hash);

}  // namespace etendue
