// MurmurHash3, 32 bits for 32-bit machines ("x86_32"), by Austin Appleby, who placed it in the public domain: the hash
// of names that Cryptomatte asks for.
#pragma once

#include <cstdint>
#include <string_view>

namespace etendue {

/// Returns the hash of the bytes of `text`, begun with `seed`.
[[nodiscard]] std::uint32_t murmur_hash3_32(std::string_view text, std::uint32_t seed = 0);

}  // namespace etendue
