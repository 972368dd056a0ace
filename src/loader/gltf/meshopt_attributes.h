// Version 1 of the attribute codec of KHR_meshopt_compression, and its colour filter.
//
// Both follow the extension's appendices A (mode 0) and B (filter 4). meshoptimizer 0.18 decodes version 0 only.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace etendue {

/// True if the first byte says that version 1 of the attribute codec made `bytes`.
[[nodiscard]] bool is_meshopt_attributes_v1(std::span<const unsigned char> bytes);

/// The `count` elements of `stride` bytes, a multiple of 4 up to 256, that `bytes` hold. Throws IoError if they are
/// damaged.
[[nodiscard]] std::vector<unsigned char> decode_meshopt_attributes_v1(std::span<const unsigned char> bytes,
                                                                      std::size_t count, std::size_t stride);

/// Turns YCoCg colours of varying precision into normalised RGBA in place: `stride` is 4 for bytes and 8 for 16 bits.
void decode_meshopt_colors(std::span<unsigned char> colors, std::size_t stride);

}  // namespace etendue
