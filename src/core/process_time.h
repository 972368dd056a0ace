// What this process has cost so far.
#pragma once

namespace etendue {

/// Seconds of processor time that this process has used, all threads together.
[[nodiscard]] double process_cpu_seconds();

}  // namespace etendue
