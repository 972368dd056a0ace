// What the system lets this process have.
#pragma once

#include <cstdint>

namespace etendue {

/// Holds the bytes of memory of its own below which the program may not be able to say what is wrong.
inline constexpr std::uint64_t kLeastMemoryLimit = std::uint64_t{256} << 20u;

/// Throws IoError, which names the limit, if this process may have less of its stack, memory or addresses than it
/// needs: libraries that are denied memory while they start crash or wait for ever.
void require_process_limits();

}  // namespace etendue
