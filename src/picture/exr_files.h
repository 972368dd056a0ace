// The EXRs of one image: itself, and its layers and depths where those have files of their own.
#pragma once

#include "color/color_config.h"
#include "image/write.h"
#include "picture/image_description.h"

#include <filesystem>
#include <string>
#include <vector>

namespace etendue {

/// Writes `image`, whose state and layers have been described, to `exr` and to files beside it, in the space, the
/// layout and the container that it asks for. `depth` is Half or Float. Throws IoError.
void write_exr_files(const std::filesystem::path& exr, const ImageDescription& image, const ColorConfig& colors,
                     PixelDepth depth);

/// Names of the files beside `exr` that hold depths and layers.
[[nodiscard]] std::vector<std::string> layer_file_names(const std::filesystem::path& exr,
                                                        const ImageDescription& image);

}  // namespace etendue
