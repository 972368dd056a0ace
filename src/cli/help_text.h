// What --help prints: options in their groups, wrapped to the width of the terminal.
#pragma once

#include "cli/command_help.h"

#include <cstddef>
#include <string>

namespace etendue {

/// Returns the help of the program or a command; `usage` is what stands after "Usage: ", and no line but those of
/// examples has more than `width` characters.
[[nodiscard]] std::string help_text(const CommandHelp& help, const std::string& usage, std::size_t width);

/// Returns the width of the terminal that stdout is, or 100 where it is none; at least 40 and at most 120 characters.
[[nodiscard]] std::size_t help_width();

}  // namespace etendue
