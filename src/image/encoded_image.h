// An image before it is decoded: what it seems to be, and how large. For the rooms image and oiio.
#pragma once

#include "image/encoded_format.h"
#include "image/read.h"

#include <cstdint>

namespace etendue {

struct EncodedImage {
    ImageSource source;
    EncodedFormat format;
    std::int64_t size = 0;  ///< bytes
};

/// Throws IoError if `source` cannot be opened, is empty, of no known format, or an OpenEXR file that claims to be
/// larger than it can be.
[[nodiscard]] EncodedImage look_at(const ImageSource& source);

}  // namespace etendue
