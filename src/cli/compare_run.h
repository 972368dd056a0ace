// The run of `etendue compare`, once its command line is read.
#pragma once

#include "cli/compare_arguments.h"
#include "session/exit_code.h"

namespace etendue {

/// Renders the variants, measures them and writes the report. Throws SceneError for variants that cannot be compared,
/// CLI::ParseError for options of a variant that cannot be read, and IoError when a file cannot be written.
[[nodiscard]] ExitCode run_compare(const CompareArguments& arguments);

}  // namespace etendue
