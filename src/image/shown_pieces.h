// Shows OpenImageIO the pixels of a file and how they are stored, and keeps comments, Exif, IPTC and XMP from it, of a
// TIFF only the last two. It reads them in time and memory that grow with the square of their number, a compressed text
// of a PNG to any size, and XMP until the stack ends; nothing of them is used here.
#pragma once

#include "image/byte_source.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// Holds a piece of a file that is shown, or zeros of that size in its place.
struct FilePiece {
    std::uint64_t begin = 0;  ///< place in the file, bytes
    std::uint64_t size = 0;
    bool is_blank = false;
};

/// Returns what of a PNG of `size` bytes is shown, piece by piece; nothing if that is all of it. Chunks that change no
/// pixel and no colour are left out.
[[nodiscard]] std::vector<FilePiece> shown_pieces_of_png(const ByteSource& source, std::uint64_t size);

/// Returns as much of a JPEG: comments and application segments that change no colour are left out. Throws RefusedInput
/// if it has more scans than any program writes, each of which is decoded for all pixels.
[[nodiscard]] std::vector<FilePiece> shown_pieces_of_jpeg(std::span<const std::byte> jpeg);

/// Returns as much of a TIFF, in whose directories IPTC and XMP get a type that does not exist, so that they are not
/// read. Throws IoError if the tags of a directory claim more than the file has, and RefusedInput if it has too many.
[[nodiscard]] std::vector<FilePiece> shown_pieces_of_tiff(const ByteSource& source, std::uint64_t size);

}  // namespace etendue
