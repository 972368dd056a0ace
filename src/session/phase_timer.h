// How long a phase takes.
#pragma once

#include "core/process_time.h"
#include "output/statistics.h"

#include <chrono>

namespace etendue {

/// Measures one phase on the clock and on the processors.
class PhaseTimer {
  public:
    [[nodiscard]] PhaseTime elapsed() const { return {seconds_since(wall_), process_cpu_seconds() - cpu_}; }

  private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point wall_ = Clock::now();
    double cpu_ = process_cpu_seconds();
};

}  // namespace etendue
