// An image on disk: EXR, PNG and statistics.
#pragma once

#include "app/image_description.h"
#include "app/output_paths.h"
#include "color/color_config.h"
#include "image/write.h"

#include <functional>

namespace etendue {

/// Writes the files of `image`, whose state has been described; fills in how long that took. `beside` is called for
/// what else belongs to the image. Layers stand where `image` says. Statistics are removed first and written last, so
/// that where they stand, the other files are of the same render, wherever it was killed. Throws IoError.
void write_image_files(const OutputPaths& paths, ImageDescription& image, const ColorConfig& colors, PixelDepth depth,
                       const std::function<void()>& beside = {});

}  // namespace etendue
