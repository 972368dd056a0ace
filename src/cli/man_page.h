// Manual pages in troff, from what --help says.
#pragma once

#include "cli/command_help.h"

#include <string>

namespace etendue {

/// The page etendue(1) of the program itself. `software` is its name and version.
[[nodiscard]] std::string program_page(const CommandHelp& program, const std::string& software);

/// The page etendue-COMMAND(1) of one command of `program`.
[[nodiscard]] std::string command_page(const CommandHelp& program, const CommandHelp& command,
                                       const std::string& software);

}  // namespace etendue
