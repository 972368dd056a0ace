// The bytes of a file or of an encoded image in memory, by their place.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>

namespace etendue {

/// Fills a span with the bytes of a file from an offset on, and returns how many there are.
using ByteSource = std::function<std::size_t(std::uint64_t offset, std::span<std::uint8_t> bytes)>;

/// Returns the bytes of a file, none if it cannot be opened. A few of them after a few others cost little.
[[nodiscard]] ByteSource byte_source(const std::filesystem::path& path);
/// Returns bytes in memory, which must outlive the result.
[[nodiscard]] ByteSource byte_source(std::span<const std::byte> all);

}  // namespace etendue
