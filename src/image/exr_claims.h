// Whether an OpenEXR file can be as large as it says, and has no more in its headers than is read in reasonable time.
#pragma once

#include "image/exr_header.h"

#include <cstdint>

namespace etendue {

/// Throws IoError if the headers of a file of `size` bytes claim what would make OpenEXR take memory out of all
/// proportion to them: attributes, tables of chunks, lines or tiles that so few bytes cannot stand for. Throws
/// RefusedInput if they have more attributes, channels or parts than any program writes.
void check_exr_claims(const ByteSource& source, std::uint64_t size);

}  // namespace etendue
