#include "session/interrupt.h"

#include <csignal>
#include <cstdlib>

namespace etendue {

namespace {

// Signal handlers can reach nothing but globals.
std::atomic<bool> requested{false};
std::atomic<bool> preview{false};
std::atomic<bool> stop_asked_for{false};
std::atomic<int> signal_number{0};
std::atomic<bool> second_ends{true};
std::atomic<int> with_nothing_to_keep{0};
std::atomic<int> with_something_to_keep{0};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

ExitCode exit_code_of(int signal) {
    return signal == SIGINT ? ExitCode::Interrupted : ExitCode::Terminated;
}

extern "C" void on_signal(int number) {
    const bool loses_nothing = with_nothing_to_keep.load() > 0 && with_something_to_keep.load() == 0;
    if (loses_nothing && !requested.load()) std::_Exit(static_cast<int>(exit_code_of(number)));
    signal_number.store(number);
    requested.store(true);
    if (!second_ends.load()) return;
    for (const int either : {SIGINT, SIGTERM}) std::signal(either, SIG_DFL);
}

extern "C" void on_preview_signal(int) {
    preview.store(true);
}

extern "C" void on_stop_signal(int) {
    stop_asked_for.store(true);
}

}  // namespace

void install_interrupt_handlers() {
    std::signal(SIGINT, on_signal);
    std::signal(SIGTERM, on_signal);
    // A terminal that is closed sends it, maybe twice; who is to outlive the terminal (nohup) ignores it.
    if (std::signal(SIGHUP, on_signal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
    std::signal(SIGUSR1, on_preview_signal);
    // A parent that ignores SIGCHLD passes that on, and then no child could be waited for.
    std::signal(SIGCHLD, SIG_DFL);
}

void take_all_interrupts_for_one() {
    second_ends.store(false);
}

const std::atomic<bool>& interrupt_requested() {
    return requested;
}

void request_interrupt() {
    int none = 0;
    if (signal_number.compare_exchange_strong(none, SIGINT)) requested.store(true);
}

void request_preview() {
    preview.store(true);
}

bool preview_requested() {
    return preview.load(std::memory_order_relaxed);
}

void clear_preview_request() {
    preview.store(false);
}

ExitCode interrupt_exit_code() {
    return exit_code_of(signal_number.load());
}

StopRequests::StopRequests() : before_(std::signal(SIGTSTP, on_stop_signal)) {
    if (before_ == SIG_IGN) std::signal(SIGTSTP, SIG_IGN);
}

StopRequests::~StopRequests() {
    std::signal(SIGTSTP, before_);
}

bool StopRequests::take() {
    return stop_asked_for.exchange(false);
}

NothingToKeep::NothingToKeep() {
    ++with_nothing_to_keep;
}

NothingToKeep::~NothingToKeep() {
    --with_nothing_to_keep;
}

SomethingToKeep::SomethingToKeep() {
    ++with_something_to_keep;
}

SomethingToKeep::~SomethingToKeep() {
    --with_something_to_keep;
}

}  // namespace etendue
