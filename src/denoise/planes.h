// Channels of an image one by one, with a border of repeated pixels around them, so that filters need not look where
// the image ends.
#pragma once

#include "image/image.h"

#include <cstddef>
#include <span>
#include <vector>

namespace etendue {

/// Largest window of the filters: 33 × 33 pixels.
inline constexpr int kLargestWindowRadius = 16;
/// Largest patch that two pixels are compared by: 7 × 7 pixels.
inline constexpr int kLargestPatchRadius = 3;
/// Window and patch, and as many pixels more as a row of a window is rounded up by.
inline constexpr int kPlaneBorder = kLargestWindowRadius + kLargestPatchRadius + 5;

/// `count` planes of width × height floats.
class Planes {
  public:
    Planes() = default;
    /// Zeros, in the border too.
    Planes(int width, int height, int count);
    /// The channels `channels` of `image`, in this order. The border is not filled yet.
    Planes(const ImageF& image, std::span<const int> channels);

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] int count() const { return count_; }

    /// Row `y` of a plane: [x] for x in [-kPlaneBorder, width + kPlaneBorder), for y in the same range of the height.
    [[nodiscard]] float* row(int plane, int y) { return values_.data() + offset(plane, y); }
    [[nodiscard]] const float* row(int plane, int y) const { return values_.data() + offset(plane, y); }

    /// Fills the border with the nearest pixels of the image.
    void extend();
    /// Puts the planes back into the channels `channels` of `image`.
    void copy_to(ImageF& image, std::span<const int> channels) const;

  private:
    [[nodiscard]] std::size_t offset(int plane, int y) const {
        const std::size_t rows = static_cast<std::size_t>(height_) + 2 * kPlaneBorder;
        return (static_cast<std::size_t>(plane) * rows + (static_cast<std::size_t>(y) + kPlaneBorder)) * stride_ +
               static_cast<std::size_t>(kPlaneBorder);
    }

    int width_ = 0;
    int height_ = 0;
    int count_ = 0;
    std::size_t stride_ = 0;
    std::vector<float> values_;
};

/// Planes of the size of `like` whose every value is `value(plane, x, y)`; the border is filled.
template <typename Function>
[[nodiscard]] Planes make_planes(int width, int height, int count, const Function& value) {
    Planes planes(width, height, count);
    for (int plane = 0; plane < count; ++plane)
        for (int y = 0; y < height; ++y) {
            float* row = planes.row(plane, y);
            for (int x = 0; x < width; ++x) row[x] = value(plane, x, y);
        }
    planes.extend();
    return planes;
}

/// Each pixel `combine(a, b)` of two planes of the same shape; the border is filled.
template <typename Function>
[[nodiscard]] Planes combined(const Planes& a, const Planes& b, const Function& combine) {
    return make_planes(a.width(), a.height(), a.count(),
                       [&](int plane, int x, int y) { return combine(a.row(plane, y)[x], b.row(plane, y)[x]); });
}

}  // namespace etendue
