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

/// True if the frame's output space is another than the one that its pixels are in.
[[nodiscard]] bool is_to_be_converted(const OutputFrame& frame);

/// Brings the pixels of `frame` and its layers of colour to its output space, which becomes its working space. Throws
/// what `convert_space` throws.
void to_output_space(OutputFrame& frame, const ColorConfig& config);

}  // namespace etendue
