// Which pixels of an image a measure is taken of.
#pragma once

#include "core/pixel_rect.h"
#include "image/image.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace etendue {

/// A rectangle of an image, without single pixels of it. The default is all of the image.
struct PixelSelection {
    std::optional<PixelRect> region{};         ///< inside the image, its first pixel being (0, 0)
    std::span<const std::uint8_t> left_out{};  ///< one per pixel of the image, by rows; other than 0: does not count

    [[nodiscard]] bool has(std::size_t pixel) const { return left_out.empty() || left_out[pixel] == 0; }
};

/// Calls `body(pixel)` for every pixel of `image` that is selected, by rows; `pixel` is its place among all pixels.
template <typename T, typename Body>
void for_each_pixel(const Image<T>& image, const PixelSelection& selection, const Body& body) {
    const PixelRect region = selection.region.value_or(PixelRect{0, 0, image.width, image.height});
    const auto width = static_cast<std::size_t>(image.width);
    for (int y = region.y0; y < region.y1; ++y) {
        const std::size_t row = static_cast<std::size_t>(y) * width;
        for (int x = region.x0; x < region.x1; ++x) {
            const std::size_t pixel = row + static_cast<std::size_t>(x);
            if (selection.has(pixel)) body(pixel);
        }
    }
}

/// Mean of the selected values of `map`, which has one channel; NaN if none is selected.
[[nodiscard]] double mean_of(const ImageF& map, const PixelSelection& selection = {});

/// The value that `share` in [0, 1] of the selected values of `map`, which has one channel, lie at or below; NaN if
/// none is selected or one of them is NaN.
[[nodiscard]] double quantile_of(const ImageF& map, double share, const PixelSelection& selection = {});

}  // namespace etendue
