// The headers of OpenEXR files, attribute by attribute, without OpenEXR.
#pragma once

#include "image/byte_source.h"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace etendue {

struct ExrAttribute {
    std::string name;
    std::string type;
    std::uint64_t name_begin = 0;  ///< offsets in the file
    std::uint64_t value_begin = 0;
    std::uint64_t value_size = 0;
};

/// Calls `visit` with the attributes of each header, of which there is one for each part, and `end_part` after the last
/// of each. Throws IoError where a header is broken, is cut off or claims more bytes than the file has, which are
/// `size`.
void walk_exr_headers(const ByteSource& source, std::uint64_t size,
                      const std::function<void(const ExrAttribute&)>& visit, const std::function<void()>& end_part);

/// Renames attribute `from` in every header of the OpenEXR file `exr`, which has one for each of its parts, to `to`,
/// which must be as long, so that nothing moves: what OpenImageIO does not let us write. Returns false, and changes
/// nothing, if there is no such attribute or the first header is broken.
bool rename_exr_attribute(std::span<std::uint8_t> exr, std::string_view from, std::string_view to);

}  // namespace etendue
