// What the processor counts while something runs: cycles, instructions, misses.
#pragma once

#include "process/file_descriptor.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace etendue {

/// Counts for all threads that the process has when this is made, and for those that they start.
class ProcessorCounters {
  public:
    /// Opens the counter of an event of PERF_TYPE_HARDWARE for a thread: a file descriptor, or -1 with errno.
    using Open = std::function<int(std::uint64_t event, int thread)>;

    /// Begins to count. Where the kernel allows nothing, or not for all threads, `unavailable` says why.
    ProcessorCounters();
    explicit ProcessorCounters(const Open& open);

    struct Count {
        std::string name;    ///< "instructions"
        double value = 0.0;  ///< scaled up if the kernel let the counter run for a part of the time only
    };
    /// Up to now; only of events that the processor has.
    [[nodiscard]] std::vector<Count> read() const;
    /// A sentence; empty if there are counts.
    [[nodiscard]] const std::string& unavailable() const { return unavailable_; }

  private:
    struct Counter {
        std::size_t event = 0;
        FileDescriptor file;
    };
    std::vector<Counter> counters_;
    std::string unavailable_;
};

}  // namespace etendue
