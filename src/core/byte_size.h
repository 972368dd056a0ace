// Amounts of memory, as people write them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace etendue {

/// What a byte size must look like, for messages.
inline constexpr std::string_view kByteSizeForm =
    "a number of up to six digits with K, M, G or T behind it, such as 8G";

/// Bytes of "512M": one to six digits and a unit of 1024, 1024², 1024³ or 1024⁴ bytes. Nothing if `text` is not of that
/// form.
[[nodiscard]] std::optional<std::uint64_t> parse_byte_size(std::string_view text);

/// As parse_byte_size reads it, in whole mebibytes, or gibibytes or tebibytes where there are too many of those;
/// rounded down.
[[nodiscard]] std::string to_byte_size(std::uint64_t bytes);

/// Memory of the machine, bytes.
[[nodiscard]] std::uint64_t physical_memory();

}  // namespace etendue
