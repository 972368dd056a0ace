// What the processor counts while something runs: cycles, instructions, misses.
#pragma once

#include "app/file_descriptor.h"

#include <string>
#include <vector>

namespace etendue {

/// Counts for all threads that the process has when this is made, and for those that they start.
class ProcessorCounters {
  public:
    /// Begins to count. Where the kernel allows nothing, `unavailable` says why.
    ProcessorCounters();

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
