// Images to look at.
#pragma once

#include "color/color_config.h"
#include "output/output_frame.h"

#include <filesystem>

namespace etendue {

/// Writes an 8-bit RGB PNG of the frame over black, through its exposure, display and view; without an exposure it is
/// shown as it is. Only the crop window is written, and of one that goes beyond the image, what lies within. Returns
/// the share of the pixels that have a channel as bright as a PNG can show. Throws SceneError if the config has no such
/// space, display or view.
double write_preview_png(const std::filesystem::path& path, const OutputFrame& frame, const ColorConfig& config);

}  // namespace etendue
