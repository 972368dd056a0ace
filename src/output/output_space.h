// From the space that light is computed in to the one that an image is written in.
#pragma once

#include "color/color_config.h"
#include "image/image.h"
#include "output/output_frame.h"

#include <string>

namespace etendue {

/// Converts `image`, of three channels or four with associated alpha, in place from one scene-linear space to another.
/// Throws SceneError if a name is unknown and IoError for other images.
void convert_space(ImageF& image, const std::string& from, const std::string& to, const ColorConfig& config);

/// The pixels of `frame` in its output space. Throws what `convert_space` throws.
[[nodiscard]] ImageF in_output_space(const OutputFrame& frame, const ColorConfig& config);

}  // namespace etendue
