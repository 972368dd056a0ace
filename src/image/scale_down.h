// Smaller images of images.
#pragma once

#include "image/image.h"
#include "image/read.h"

namespace etendue {

/// Returns `image` with `width` > 0 columns and its aspect, each pixel the mean of the box of pixels that it covers; an
/// image that has no more columns is returned as it is.
[[nodiscard]] ImageF scale_down(const ImageF& image, int width);

/// Scales the image of `source` down as `scale_down` does, reading row by row, so that it is never in memory as a
/// whole. Throws IoError as `read_image_float` does, and for images that are stored in tiles.
[[nodiscard]] ImageF read_scaled_down(const ImageSource& source, int width);

}  // namespace etendue
