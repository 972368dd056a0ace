// SIGINT and SIGTERM: the first asks the render to stop and write what there is, the second ends the process at once.
#pragma once

#include "app/exit_code.h"

#include <atomic>

namespace etendue {

/// Installs the handlers; once, from main.
void install_interrupt_handlers();

/// Becomes true when a signal has arrived.
[[nodiscard]] const std::atomic<bool>& interrupt_requested();

/// Interrupted or Terminated, by the signal that arrived.
[[nodiscard]] ExitCode interrupt_exit_code();

}  // namespace etendue
