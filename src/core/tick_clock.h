// A clock for times of microseconds: the processor's own counter, which costs a third of what the system's clock does.
#pragma once

#include <chrono>
#include <cstdint>

namespace etendue {

/// Ticks of a counter that runs at one speed on all cores.
[[nodiscard]] inline std::uint64_t ticks_now() {
#if defined(__x86_64__)
    return __builtin_ia32_rdtsc();
#else
    return static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
#endif
}

/// How long ticks are, measured from when this was made: to a thousandth after a few milliseconds.
class TickScale {
  public:
    [[nodiscard]] double seconds_per_tick() const {
        const std::uint64_t ticks = ticks_now() - ticks_;
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - time_;
        return ticks > 0 ? elapsed.count() / static_cast<double>(ticks) : 0.0;
    }
    /// True if this one was made before.
    [[nodiscard]] bool is_older_than(const TickScale& other) const { return time_ < other.time_; }

  private:
    std::chrono::steady_clock::time_point time_ = std::chrono::steady_clock::now();
    std::uint64_t ticks_ = ticks_now();
};

}  // namespace etendue
