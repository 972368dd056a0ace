// Amounts of memory, as people write them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace etendue {

/// Says what a byte size looks like, for messages.
inline constexpr std::string_view kByteSizeForm =
    "a number of up to six digits with K, M, G or T behind it, such as 8G";

/// Bytes of "512M", "512MB" or "512MiB": one to six digits and a unit of 1024, 1024², 1024³ or 1024⁴ bytes. Nothing if
/// `text` is not of that form.
[[nodiscard]] std::optional<std::uint64_t> parse_byte_size(std::string_view text);

/// Writes `bytes` as parse_byte_size reads them, rounded down: in whole mebibytes, or in gibibytes or tebibytes where
/// there are too many of those.
[[nodiscard]] std::string to_byte_size(std::uint64_t bytes);

/// Memory of the machine, bytes.
[[nodiscard]] std::uint64_t physical_memory();

}  // namespace etendue
