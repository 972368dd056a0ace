// Files, whole or not at all: written under a temporary name beside their own and renamed, so that no reader ever sees
// half of one, and none is left behind under its own name by a full disk or a kill.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>

namespace etendue {

/// Takes the next bytes of a file.
using ByteSink = std::function<void(std::span<const std::byte>)>;

/// Writes what `produce` hands to its sink, piece by piece, so that the file need not be in memory at once. The bytes
/// are on the disk before the name is. A link is followed, and what exists and is no regular file (a pipe, a device) is
/// written in place, since renaming would replace it; a pipe must have a reader. Creates no directory. Throws IoError
/// with the path and the reason; the temporary file is gone then, as it is when `produce` throws.
///
/// It is `.NAME.HOST-N.etendue.tmp` beside NAME, and locked while it is written: what a killed writer left is known by
/// that, and used again by the next writer of the same file. On file systems without locks it is known by its age.
void write_file(const std::filesystem::path& path, const std::function<void(const ByteSink&)>& produce);

/// Writes `bytes`, which are in memory already, to the file `path` as `write_file` does.
void write_bytes(const std::filesystem::path& path, std::span<const std::byte> bytes);
/// Writes `text` to the file `path` as `write_file` does.
void write_text(const std::filesystem::path& path, const std::string& text);

/// Throws IoError if `path` names a pipe or a socket, since opening one waits for whoever reads it. What the process
/// has opened already may be one, such as /dev/stdout.
void require_no_pipe(const std::filesystem::path& path);

/// Removes what killed writers of `path` on this host have left, for when it will not be written again. Without locks,
/// only what is an hour old.
void remove_abandoned_files_of(const std::filesystem::path& path);

/// Removes the temporary files that killed writers have left in `directory` and below: those of this host that nobody
/// has open for writing, and those of other hosts that are an hour old. Returns how many. What cannot be read or
/// removed is left.
std::size_t remove_abandoned_files(const std::filesystem::path& directory);

}  // namespace etendue
