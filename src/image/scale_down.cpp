#include "image/scale_down.h"

#include "image/image_reader.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace etendue {

namespace {

/// Takes the rows of a large image one after the other and makes the small one of them.
class BoxAverage {
  public:
    BoxAverage(int columns, int rows, int channels, int width)
        : columns_(columns),
          rows_(rows),
          small_(width, std::max(1, static_cast<int>(std::lround(static_cast<double>(rows) * width / columns))),
                 channels),
          sums_(static_cast<std::size_t>(width) * static_cast<std::size_t>(channels)) {}

    void add(std::span<const float> row) {
        const auto channels = static_cast<std::size_t>(small_.channels);
        for (int x = 0; x < small_.width; ++x) {
            const int end = edge(x + 1, columns_, small_.width);
            double* const sums = &sums_[static_cast<std::size_t>(x) * channels];
            for (int u = edge(x, columns_, small_.width); u < end; ++u)
                for (std::size_t c = 0; c < channels; ++c)
                    sums[c] += static_cast<double>(row[static_cast<std::size_t>(u) * channels + c]);
        }
        ++taken_;
        if (taken_ == edge(y_ + 1, rows_, small_.height)) finish_row();
    }

    [[nodiscard]] ImageF take() { return std::move(small_); }

  private:
    /// Where pixel `i` of `to` begins in a line of `from`; `from` is no less than `to`, so that none is empty.
    static int edge(int i, int from, int to) { return static_cast<int>(static_cast<std::int64_t>(i) * from / to); }

    void finish_row() {
        const int box_rows = taken_ - edge(y_, rows_, small_.height);
        for (int x = 0; x < small_.width; ++x) {
            const int box_columns = edge(x + 1, columns_, small_.width) - edge(x, columns_, small_.width);
            const std::span<float> pixel = small_.pixel(x, y_);
            for (std::size_t c = 0; c < pixel.size(); ++c)
                pixel[c] = static_cast<float>(sums_[static_cast<std::size_t>(x) * pixel.size() + c] /
                                              (box_columns * box_rows));
        }
        std::ranges::fill(sums_, 0.0);
        ++y_;
    }

    int columns_;
    int rows_;
    ImageF small_;
    std::vector<double> sums_;  ///< sums of the row of the small image that is under way
    int y_ = 0;
    int taken_ = 0;
};

std::size_t row_size(int columns, int channels) {
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(channels);
}

}  // namespace

ImageF scale_down(const ImageF& image, int width) {
    if (width >= image.width) return image;
    BoxAverage average(image.width, image.height, image.channels, width);
    const std::size_t size = row_size(image.width, image.channels);
    for (int y = 0; y < image.height; ++y)
        average.add(std::span(image.pixels).subspan(static_cast<std::size_t>(y) * size, size));
    return average.take();
}

ImageF read_scaled_down(const ImageSource& source, int width) {
    ImageReader reader(source);
    const ImageInfo& info = reader.info();
    if (width >= info.width) return read_image_float(source);
    BoxAverage average(info.width, info.height, info.decoded_channels, width);
    std::vector<float> row(row_size(info.width, info.decoded_channels));
    for (int y = 0; y < info.height; ++y) {
        reader.read_rows(0, y, y + 1, row);
        average.add(row);
    }
    return average.take();
}

}  // namespace etendue
