// Pieces of an image, for what holds no image whole.
#pragma once

#include "image/read.h"

#include <memory>
#include <span>
#include <vector>

namespace etendue {

/// An open image file, or encoded image in memory, whose bytes must outlive the reader. One call at a time.
class ImageReader {
  public:
    /// Throws IoError as `read_image_info` does.
    explicit ImageReader(const ImageSource& source);
    ~ImageReader();
    ImageReader(ImageReader&&) noexcept;
    ImageReader& operator=(ImageReader&&) noexcept;

    [[nodiscard]] const ImageInfo& info() const;
    /// The image, and those of the file's mip levels that each halve the one before (rounded down).
    [[nodiscard]] std::span<const ImageLevel> levels() const;
    /// Size of the tiles the file is stored in, the same for all levels; 0 × 0 if it is stored by rows.
    [[nodiscard]] ImageLevel tile() const;

    /// Rows [y_begin, y_end) of a level that is stored by rows: floats scaled as by `read_image_float`,
    /// `decoded_channels` of them a pixel. Throws IoError if the pixels are broken.
    void read_rows(int level, int y_begin, int y_end, std::span<float> values);
    /// The tile whose first pixel is (x, y), whole even where it reaches beyond the image; else as `read_rows`.
    void read_tile(int level, int x, int y, std::span<float> values);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace etendue
