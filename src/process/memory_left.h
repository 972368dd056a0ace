// How much memory there is for more processes.
#pragma once

#include <cstdint>
#include <filesystem>

#include <sys/types.h>

namespace etendue {

/// Returns the bytes that processes may still take before the machine, or the control group (cgroup, version 2) of this
/// process, has no more: what caches of files hold counts as free. Reads `proc` and `groups`, which are /proc and
/// /sys/fs/cgroup.
[[nodiscard]] std::uint64_t free_memory_bytes(const std::filesystem::path& proc = "/proc",
                                              const std::filesystem::path& groups = "/sys/fs/cgroup");

/// Returns the bytes that the process has resident and shares with no file; 0 if there is no such process.
[[nodiscard]] std::uint64_t process_memory_bytes(pid_t process);

}  // namespace etendue
