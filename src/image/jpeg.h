// JPEG files in memory, for images that are small enough to be part of a page.
#pragma once

#include "image/image.h"

#include <vector>

namespace etendue {

/// The bytes of a JPEG file of `image`, whose values lie in [0, 1] and are encoded for display: of its first three
/// channels, or of the first if it has fewer than three. `quality` lies in [1, 100]. Throws IoError.
[[nodiscard]] std::vector<unsigned char> encode_jpeg(const ImageF& image, int quality);

}  // namespace etendue
