// An image on disk: EXR, PNG and statistics.
#pragma once

#include "color/color_config.h"
#include "image/write.h"
#include "picture/image_description.h"
#include "picture/output_paths.h"

#include <functional>
#include <string>
#include <vector>

namespace etendue {

/// Writes the files of `image`, whose state has been described; fills in how long that took. `beside` is called for
/// what else belongs to the image. Layers stand where `image` says. Statistics are removed first and written last, so
/// that where they stand, the other files are of the same render, wherever it was killed. Returns the names of files
/// that belonged to the image which has been replaced, as its statistics said, and are still there: of layers and
/// depths that this one does not have. Throws IoError.
std::vector<std::string> write_image_files(const OutputPaths& paths, ImageDescription& image, const ColorConfig& colors,
                                           PixelDepth depth, const std::function<void()>& beside = {});

/// A note for each of these names.
void note_earlier_files(const std::vector<std::string>& names);

}  // namespace etendue
