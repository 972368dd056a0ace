// The program as main() runs it.
#pragma once

#include "cli/commands.h"

namespace etendue {

/// Runs `action` and turns what it throws into messages and exit codes.
[[nodiscard]] ExitCode run_action(const Action& action);

/// Runs the command that `argv` names and returns the exit code of the process. It may be called once in a process,
/// since it installs handlers of signals.
[[nodiscard]] int run_program(int argc, char** argv);

}  // namespace etendue
