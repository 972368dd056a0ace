// Smaller images of images.
#pragma once

#include "image/image.h"
#include "image/read.h"

namespace etendue {

/// `image` with `width` > 0 columns and its aspect, each pixel the mean of the box of pixels that it covers; as it is
/// if it has no more columns.
[[nodiscard]] ImageF scale_down(const ImageF& image, int width);

/// The same of the image that `source` holds by rows, which is read row by row and is not in memory as a whole. Throws
/// IoError as `read_image_float` does, and for images that are stored in tiles.
[[nodiscard]] ImageF read_scaled_down(const ImageSource& source, int width);

}  // namespace etendue
