#include "image/scale_down.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace etendue {

ImageF scale_down(const ImageF& image, int width) {
    if (width >= image.width) return image;
    const int height =
        std::max(1, static_cast<int>(std::lround(static_cast<double>(image.height) * width / image.width)));
    ImageF small(width, height, image.channels);
    const auto edge = [](int i, int from, int to) {
        return static_cast<int>(static_cast<std::int64_t>(i) * from / to);
    };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const int x0 = edge(x, image.width, width);
            const int x1 = std::max(x0 + 1, edge(x + 1, image.width, width));
            const int y0 = edge(y, image.height, height);
            const int y1 = std::max(y0 + 1, edge(y + 1, image.height, height));
            for (int c = 0; c < image.channels; ++c) {
                const auto channel = static_cast<std::size_t>(c);
                double sum = 0.0;
                for (int v = y0; v < y1; ++v)
                    for (int u = x0; u < x1; ++u) sum += static_cast<double>(image.pixel(u, v)[channel]);
                small.pixel(x, y)[channel] = static_cast<float>(sum / ((x1 - x0) * (y1 - y0)));
            }
        }
    return small;
}

}  // namespace etendue
