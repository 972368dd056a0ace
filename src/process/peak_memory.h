// What the process has taken.
#pragma once

#include <cstdint>

namespace etendue {

/// Most bytes that the process has had resident.
[[nodiscard]] std::uint64_t peak_memory_bytes();

}  // namespace etendue
