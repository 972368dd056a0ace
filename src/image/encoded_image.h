// An image before it is decoded: what it seems to be, and how large. For the rooms image and oiio.
#pragma once

#include "image/encoded_format.h"
#include "image/radiance_header.h"
#include "image/read.h"
#include "image/shown_pieces.h"

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
    /// Lists the pieces of `source` that the library is shown; all of it is if there are none.
    std::vector<FilePiece> pieces{};
    /// How to develop what is decoded, of a Radiance picture that the library would not read as it is meant. Then
    /// `source` is `rewritten`, with a header that it does read.
    std::optional<RadianceHeader> radiance{};
    /// Holds the bytes of `source` if they are not those of the file: of such a picture, or of a JPEG without what the
    /// library is not shown, which it reads from a file or from memory alone.
    std::shared_ptr<const std::vector<std::byte>> rewritten{};
};

/// Throws IoError if `source` cannot be opened, is empty, of no known format, or claims in its headers to have what it
/// cannot have or nobody writes.
[[nodiscard]] EncodedImage look_at(const ImageSource& source);

}  // namespace etendue
