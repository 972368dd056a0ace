// An image before it is decoded: what it seems to be, and how large. For the rooms image and oiio.
#pragma once

#include "image/encoded_format.h"
#include "image/radiance_header.h"
#include "image/read.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace etendue {

struct EncodedImage {
    ImageSource source;
    EncodedFormat format;
    std::int64_t size = 0;  ///< bytes
    /// How to develop what is decoded, of a Radiance picture that the library would not read as it is meant. Then
    /// `source` is `rewritten`, with a header that it does read.
    std::optional<RadianceHeader> radiance{};
    std::shared_ptr<const std::vector<std::byte>> rewritten{};
};

/// Throws IoError if `source` cannot be opened, is empty, of no known format, or an OpenEXR file that claims to be
/// larger than it can be.
[[nodiscard]] EncodedImage look_at(const ImageSource& source);

}  // namespace etendue
