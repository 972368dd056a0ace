// A rectangle of pixels.
#pragma once

#include <algorithm>
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
    /// True if no pixel lies in the rectangle.
    [[nodiscard]] bool empty() const { return x1 <= x0 || y1 <= y0; }
    [[nodiscard]] bool contains(int x, int y) const { return x >= x0 && x < x1 && y >= y0 && y < y1; }
    friend bool operator==(const PixelRect&, const PixelRect&) = default;
};

/// The pixels that lie in both; empty() if there are none.
[[nodiscard]] inline PixelRect intersection(const PixelRect& a, const PixelRect& b) {
    return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

/// `rect` with its corner (x0, y0) at pixel (x, y).
[[nodiscard]] inline PixelRect moved_to(const PixelRect& rect, int x, int y) {
    return {x, y, x + rect.width(), y + rect.height()};
}

}  // namespace etendue
