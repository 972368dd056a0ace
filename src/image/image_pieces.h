// An open image that is read in pieces. For the rooms image, texture and oiio.
#pragma once

#include "image/read.h"

#include <span>

namespace etendue {

/// Reads an open image in pieces; its functions do what those of ImageReader do.
class ImagePieces {
  public:
    virtual ~ImagePieces() = default;

    [[nodiscard]] virtual const ImageInfo& info() const = 0;
    [[nodiscard]] virtual std::span<const ImageLevel> levels() const = 0;
    [[nodiscard]] virtual ImageLevel tile() const = 0;
    virtual void read_rows(int level, int y_begin, int y_end, std::span<float> values) = 0;
    virtual void read_tile(int level, int x, int y, std::span<float> values) = 0;
};

}  // namespace etendue
