// Images as they are displayed: an EXR may hold less than that, or more.
#pragma once

#include "image/read.h"

#include <vector>

namespace etendue {

/// True if the pixels of the file are those of the displayed image. Windows other than EXR's say where a picture is to
/// be printed, and count for nothing.
[[nodiscard]] bool fills_display(const ImageInfo& info);

/// Describes the displayed image as `read_image_info` does, with the size of the display window. Throws IoError as that
/// does, and RefusedInput if the display window is far larger than what the file holds of it.
[[nodiscard]] ImageInfo read_displayed_info(const ImageSource& source);

/// Decodes as `read_image_float`, with the pixels at their place in the display window and zeros where it has none.
[[nodiscard]] ImageF read_displayed_float(const ImageSource& source);

/// Decodes as `read_image_levels`, with the pixels at their place in the display window and zeros where it has none;
/// then mip levels of the file are left out.
[[nodiscard]] std::vector<NativeImage> read_displayed_levels(const ImageSource& source);

}  // namespace etendue
