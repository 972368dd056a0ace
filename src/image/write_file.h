// Bytes to a file, whole or not at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace etendue {

/// Writes `bytes` under a temporary name beside `path` and renames it to `path`. A link is followed, and what exists
/// and is no regular file (a pipe, a device) is written in place, since renaming would replace it. Creates no
/// directory. Throws IoError with the path and the reason; the temporary file is gone then.
void write_bytes(const std::filesystem::path& path, std::span<const std::byte> bytes);

}  // namespace etendue
