// The one thing in an EXR header that OpenImageIO does not let us write.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace etendue {

/// Renames attribute `from` in every header of the OpenEXR file `exr`, which has one for each of its parts, to `to`,
/// which must be as long, so that nothing moves. Returns false, and changes nothing, if there is no such attribute or
/// the first header is broken.
bool rename_exr_attribute(std::span<std::uint8_t> exr, std::string_view from, std::string_view to);

}  // namespace etendue
