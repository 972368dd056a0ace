// The program as main() runs it.
#pragma once

namespace etendue {

/// Runs the command that `argv` names and returns the exit code of the process. Once in a process: it installs handlers
/// of signals.
[[nodiscard]] int run_program(int argc, char** argv);

}  // namespace etendue
