// Decoded images in memory. Rows run from the top down; channels are interleaved.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// Pixels as 32-bit floats.
struct ImageF {
    int width = 0;
    int height = 0;
    int channels = 0;
    std::vector<float> pixels;  ///< width * height * channels

    ImageF() = default;
    ImageF(int w, int h, int c)
        : width(w),
          height(h),
          channels(c),
          pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * static_cast<std::size_t>(c)) {}

    [[nodiscard]] std::span<float> pixel(int x, int y) { return {pixels.data() + offset(x, y), std::size_t(channels)}; }
    [[nodiscard]] std::span<const float> pixel(int x, int y) const {
        return {pixels.data() + offset(x, y), std::size_t(channels)};
    }

  private:
    [[nodiscard]] std::size_t offset(int x, int y) const {
        return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
               static_cast<std::size_t>(channels);
    }
};

/// Pixels as they stood in the file, for textures that keep the file's depth.
struct Image8 {
    int width = 0;
    int height = 0;
    int channels = 0;
    std::vector<std::uint8_t> pixels;  ///< width * height * channels, as encoded (not linearised)
};

}  // namespace etendue
