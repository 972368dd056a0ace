// Runs another program and waits for it.
#pragma once

#include <string>
#include <vector>

namespace etendue {

struct CommandResult {
    int exit_code = 0;  ///< 128 + signal if a signal ended it
    std::string out;    ///< text that the command wrote to stdout
    std::string err;    ///< text that the command wrote to stderr
};

/// Runs words[0], looked up in PATH, with the other words as its arguments, without a shell and with an empty stdin.
/// Nothing of its output is shown. Throws IoError if it cannot be started.
[[nodiscard]] CommandResult run_command(const std::vector<std::string>& words);

}  // namespace etendue
