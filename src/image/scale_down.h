// Smaller images of images.
#pragma once

#include "image/image.h"

namespace etendue {

/// `image` with `width` > 0 columns and its aspect, each pixel the mean of the box of pixels that it covers; as it is
/// if it has no more columns.
[[nodiscard]] ImageF scale_down(const ImageF& image, int width);

}  // namespace etendue
