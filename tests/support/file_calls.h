// What a test program asks of the file system, in order, and the clock that its files have. The calls take the place of
// the C library's in every program that uses this.
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace etendue {

/// While it lives, the calls are put down that decide what is left after a loss of power: "fsync NAME BYTES" and
/// "rename NAME". NAME is that of the file without its directories, before it is renamed. Of one thread.
class FileCalls {
  public:
    FileCalls();
    ~FileCalls();
    FileCalls(const FileCalls&) = delete;
    FileCalls& operator=(const FileCalls&) = delete;

    [[nodiscard]] const std::vector<std::string>& all() const;
};

/// While it lives, what is touched gets a time that is `ahead` of this machine's clock, as if a server gave it.
class ServerClock {
  public:
    explicit ServerClock(std::chrono::seconds ahead);
    ~ServerClock();
    ServerClock(const ServerClock&) = delete;
    ServerClock& operator=(const ServerClock&) = delete;
};

}  // namespace etendue
