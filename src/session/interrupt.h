// SIGINT, SIGTERM and, unless it is ignored, SIGHUP: the first asks the render to stop and write what there is, or ends
// the process where nothing would be lost; a second SIGINT or SIGTERM ends it in any case. SIGUSR1 asks it to show what
// there is and to go on.
#pragma once

#include "session/exit_code.h"

#include <atomic>

namespace etendue {

/// Installs the handlers; once, from main.
void install_interrupt_handlers();

/// From now on all signals are as the first, and none ends the process at once: for one that another process looks
/// after. A signal to all processes of a group or a job reaches it twice, once through that other one.
void take_all_interrupts_for_one();

/// Becomes true when a signal has arrived.
[[nodiscard]] const std::atomic<bool>& interrupt_requested();

/// Lets the first signal end the process at once while one lives: for what reads and builds, and looks at no request.
class NothingToKeep {
  public:
    NothingToKeep();
    ~NothingToKeep();
    NothingToKeep(const NothingToKeep&) = delete;
    NothingToKeep& operator=(const NothingToKeep&) = delete;
};

/// Makes signals requests again while one lives, where there is something to write that would be lost.
class SomethingToKeep {
  public:
    SomethingToKeep();
    ~SomethingToKeep();
    SomethingToKeep(const SomethingToKeep&) = delete;
    SomethingToKeep& operator=(const SomethingToKeep&) = delete;
};

/// Asks for what the first SIGINT asks for, and ends nothing: whoever calls has to answer. Does nothing after any
/// signal.
void request_interrupt();

/// Does what SIGUSR1 does.
void request_preview();

/// True after SIGUSR1, until it is cleared.
[[nodiscard]] bool preview_requested();
void clear_preview_request();

/// Turns SIGTSTP (Ctrl-Z) into a request while an object exists, so that a program can suspend its child processes
/// before itself. Otherwise SIGTSTP suspends this process at once. If SIGTSTP is ignored, it stays ignored.
class StopRequests {
  public:
    StopRequests();
    ~StopRequests();
    StopRequests(const StopRequests&) = delete;
    StopRequests& operator=(const StopRequests&) = delete;

    /// Returns whether a request has come since the last call.
    [[nodiscard]] bool take();

  private:
    void (*before_)(int);
};

/// Interrupted or Terminated, by the signal that arrived.
[[nodiscard]] ExitCode interrupt_exit_code();

}  // namespace etendue
