// OpenEXR files that satisfy SMPTE ST 2065-4, the ACES Image Container.
#pragma once

#include "color/color_config.h"
#include "output/output_frame.h"

#include <filesystem>

namespace etendue {

/// Writes the frame in ACES2065-1, whatever space it says it is written in: scan lines of R, G, B and, where the frame
/// has it, A in 16-bit floats, not compressed. The header has what the standard requires and a comment that says how
/// the image was made, and nothing else. docs/colour.md lists the constraints. NaN becomes 0, and what is beyond the
/// largest 16-bit float that one: other values are not valid there. Throws SceneError if the config has no ACES2065-1.
void write_aces(const std::filesystem::path& path, const OutputFrame& frame, const ColorConfig& config);

}  // namespace etendue
