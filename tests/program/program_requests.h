// Tests ask a program to start commands and to tell how they end. Each request and each answer is one message over a
// pair of sockets.
#pragma once

#include <cstddef>

#include <sys/types.h>

namespace etendue::test {

/// The only argument of the program that makes it serve.
inline constexpr const char* kServe = "--serve-tests";
/// Descriptor over which it is asked.
inline constexpr int kRequests = 3;
/// Bytes of the longest request.
inline constexpr std::size_t kLongestRequest = std::size_t{1} << 17;

enum class Request : int {
    Start,     ///< answered with the process id of a copy that runs a command
    HasEnded,  ///< answered with 1 once a copy has ended, and 0 before
    Wait       ///< answered with the status of a copy when it has ended, as waitpid gives it
};

/// Each request begins with it. A Start goes on with strings, each ended by a zero: the directory to run in, the
/// files for stdout and stderr, the words of the command, the variables of the environment.
struct RequestHead {
    Request request = Request::Start;
    pid_t pid = 0;      ///< process id of the copy, unless it is to be started
    int words = 0;      ///< number of the command's words
    int variables = 0;  ///< number of the environment's variables
};

}  // namespace etendue::test
