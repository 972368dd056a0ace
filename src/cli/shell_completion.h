// Completion of the command line in shells, from what --help says.
#pragma once

#include "cli/command_help.h"

#include <string>

namespace etendue {

/// A script that bash-completion loads as completions/etendue.
[[nodiscard]] std::string bash_completion(const CommandHelp& program);

/// A function that zsh loads as _etendue.
[[nodiscard]] std::string zsh_completion(const CommandHelp& program);

/// A script that fish loads as completions/etendue.fish.
[[nodiscard]] std::string fish_completion(const CommandHelp& program);

}  // namespace etendue
