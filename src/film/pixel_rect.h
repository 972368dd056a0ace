// A rectangle of pixels.
#pragma once

#include <cstddef>

namespace etendue {

/// Pixels [x0, x1) × [y0, y1), y down, in the coordinates of the full image.
struct PixelRect {
    int x0 = 0;
    int y0 = 0;
    int x1 = 0;
    int y1 = 0;

    [[nodiscard]] int width() const { return x1 - x0; }
    [[nodiscard]] int height() const { return y1 - y0; }
    [[nodiscard]] std::size_t area() const {
        return static_cast<std::size_t>(width()) * static_cast<std::size_t>(height());
    }
    friend bool operator==(const PixelRect&, const PixelRect&) = default;
};

}  // namespace etendue
