// The command lines of the tasks of a farm, each a line of a shell.
#pragma once

#include "farm/farm_plan.h"

#include <string>

namespace etendue {

/// Returns the command that renders the image in one piece, going on with what an earlier start has left. The shell
/// becomes the program, so that a signal to the one reaches the other.
[[nodiscard]] std::string whole_image_command(const FarmImage& image, const FarmOptions& options);

/// Returns the command that renders one part of the image, as `whole_image_command` does for all of it.
[[nodiscard]] std::string part_command(const FarmImage& image, const SampleRange& range, const FarmOptions& options);

/// Returns the command that makes the image of its parts, and removes them with their folder if that succeeds; where
/// that is done already, the command does nothing and succeeds. The folder is there before any part is.
[[nodiscard]] std::string merge_command(const FarmImage& image, const FarmOptions& options);

}  // namespace etendue
