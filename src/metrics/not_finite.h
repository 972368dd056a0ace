// Pixels that are no numbers to compare: NaN and the infinities.
#pragma once

#include "core/pixel_rect.h"
#include "core/vec.h"
#include "image/image.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// The pixels of an image with a channel that is NaN or infinite.
struct NotFinite {
    /// Limits the number of pixels that `first` holds.
    static constexpr std::size_t kMostFirst = 8;

    std::size_t nan = 0;       ///< pixels with NaN in a channel
    std::size_t infinite = 0;  ///< pixels with an infinity in a channel, and NaN in none
    PixelRect bounds;          ///< the smallest rectangle that holds them all
    std::vector<Vec2i> first;  ///< where the first of them are, by rows

    [[nodiscard]] std::size_t count() const { return nan + infinite; }
};

/// Looks for them in all channels of `image`; (0, 0) is its first pixel.
[[nodiscard]] NotFinite find_not_finite(const ImageF& image);

/// One per pixel, by rows: 1 where `image` or `reference` is not finite, else 0; for PixelSelection::left_out. Throws
/// std::invalid_argument if their shapes differ.
[[nodiscard]] std::vector<std::uint8_t> mark_not_finite(const ImageF& image, const ImageF& reference);

/// Sets all channels of the pixels with a mark other than 0 to 0. Filters over the image then see black there, in the
/// image and in its reference alike.
void blank(ImageF& image, std::span<const std::uint8_t> marks);

}  // namespace etendue
