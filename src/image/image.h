// Decoded images in memory. Rows run from the top down; channels are interleaved.
#pragma once

#include "core/float16.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

namespace etendue {

template <typename T>
struct Image {
    int width = 0;
    int height = 0;
    int channels = 0;
    std::vector<T> pixels;  ///< width * height * channels

    Image() = default;
    Image(int w, int h, int c)
        : width(w),
          height(h),
          channels(c),
          pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * static_cast<std::size_t>(c)) {}

    [[nodiscard]] std::span<T> pixel(int x, int y) { return {pixels.data() + offset(x, y), std::size_t(channels)}; }
    [[nodiscard]] std::span<const T> pixel(int x, int y) const {
        return {pixels.data() + offset(x, y), std::size_t(channels)};
    }

  private:
    [[nodiscard]] std::size_t offset(int x, int y) const {
        return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
               static_cast<std::size_t>(channels);
    }
};

using ImageF = Image<float>;
using ImageH = Image<Float16>;
/// Integers as they stood in the file: as encoded, not linearised.
using Image8 = Image<std::uint8_t>;
using Image16 = Image<std::uint16_t>;

/// An image in its file's own depth.
using NativeImage = std::variant<Image8, Image16, ImageH, ImageF>;

}  // namespace etendue
