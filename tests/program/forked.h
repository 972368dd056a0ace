// A part of a test in a process of its own.
#pragma once

#include <csignal>
#include <exception>
#include <functional>

#include <sys/prctl.h>
#include <sys/types.h>
#include <unistd.h>

namespace etendue::test {

/// Starts a copy of this process that ends with what `body` returns, without a word to the test's framework; with 99 if
/// it throws, and no later than this process. The caller waits for it.
inline pid_t run_forked(const std::function<int()>& body) {
    const pid_t pid = fork();
    if (pid != 0) return pid;
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    try {
        _exit(body());
    } catch (const std::exception&) {
        _exit(99);
    }
}

}  // namespace etendue::test
