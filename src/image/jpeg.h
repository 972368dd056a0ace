// JPEG files: encoding those that are small enough to be part of a page, and knowing those that are cut off.
#pragma once

#include "image/image.h"
#include "image/read.h"

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace etendue {

/// The bytes of a JPEG file of `image`, whose values lie in [0, 1] and are encoded for display: of its first three
/// channels, or of the first if it has fewer than three. `quality` lies in [1, 100]. Throws IoError.
[[nodiscard]] std::vector<unsigned char> encode_jpeg(const ImageF& image, int quality);

/// Calls `visit` with the marker and the bytes [begin, end) of each segment of a JPEG up to its end marker, coded data
/// left out. Returns whether there is an end marker.
bool walk_jpeg_segments(std::span<const std::byte> jpeg,
                        const std::function<void(unsigned marker, std::size_t begin, std::size_t end)>& visit);

/// True for a JPEG whose data ends before its end marker: decoders make up the rest without a word. Throws IoError if
/// `source` cannot be read.
[[nodiscard]] bool is_cut_jpeg(const ImageSource& source);

}  // namespace etendue
