// What this process has cost so far, and how long something has taken.
#pragma once

#include <chrono>

namespace etendue {

/// Seconds of processor time that this process has used, all threads together.
[[nodiscard]] double process_cpu_seconds();

/// Returns the seconds of processor time that the calling thread has used.
[[nodiscard]] double thread_cpu_seconds();

/// Seconds on the clock since this process began, to a hundredth; 0 where the system does not tell.
[[nodiscard]] double seconds_since_process_start();

/// Seconds that have passed since `start`.
[[nodiscard]] inline double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace etendue
