#include "denoise/planes.h"

#include <algorithm>

namespace etendue {

Planes::Planes(int width, int height, int count)
    : width_(width),
      height_(height),
      count_(count),
      stride_(static_cast<std::size_t>(width + 2 * kPlaneBorder)),
      values_(stride_ * static_cast<std::size_t>(height + 2 * kPlaneBorder) * static_cast<std::size_t>(count)) {}

Planes::Planes(const ImageF& image, std::span<const int> channels)
    : Planes(image.width, image.height, static_cast<int>(channels.size())) {
    for (int plane = 0; plane < count_; ++plane) {
        const auto channel = static_cast<std::size_t>(channels[static_cast<std::size_t>(plane)]);
        for (int y = 0; y < height_; ++y) {
            float* values = row(plane, y);
            for (int x = 0; x < width_; ++x) values[x] = image.pixel(x, y)[channel];
        }
    }
}

void Planes::extend() {
    for (int plane = 0; plane < count_; ++plane) {
        for (int y = 0; y < height_; ++y) {
            float* values = row(plane, y);
            std::fill(values - kPlaneBorder, values, values[0]);
            std::fill(values + width_, values + width_ + kPlaneBorder, values[width_ - 1]);
        }
        const auto copy_row = [&](int from, int to) {
            const float* source = row(plane, from) - kPlaneBorder;
            std::copy(source, source + stride_, row(plane, to) - kPlaneBorder);
        };
        for (int i = 1; i <= kPlaneBorder; ++i) {
            copy_row(0, -i);
            copy_row(height_ - 1, height_ - 1 + i);
        }
    }
}

void Planes::copy_to(ImageF& image, std::span<const int> channels) const {
    for (int plane = 0; plane < count_; ++plane) {
        const auto channel = static_cast<std::size_t>(channels[static_cast<std::size_t>(plane)]);
        for (int y = 0; y < height_; ++y) {
            const float* values = row(plane, y);
            for (int x = 0; x < width_; ++x) image.pixel(x, y)[channel] = values[x];
        }
    }
}

}  // namespace etendue
