// All channels of an image with many layers, and all that its header says of them.
#pragma once

#include "image/read.h"
#include "image/write.h"

#include <string>
#include <vector>

namespace etendue {

struct ChannelImage {
    ImageF pixels;                           ///< all channels
    std::vector<std::string> channel_names;  ///< one for each, unlike all others; layers are written "layer.R"
    PixelDepth depth = PixelDepth::Float;    ///< Half if all channels are, else Float
    PixelRect data_window;                   ///< as in ImageInfo
    PixelRect display_window;
    /// What `write_image` can write again: numbers, texts, matrices and eight floats of chromaticities, but not what
    /// says how the file is stored.
    std::vector<ImageAttribute> attributes;

    /// The attribute of that name, or nothing.
    [[nodiscard]] const ImageAttribute* find(std::string_view name) const;
};

/// Reads the first part of an OpenEXR file, or an image of another format whose channels are floats. Throws IoError as
/// `read_image_info` does, and if a channel holds integers or two have one name.
[[nodiscard]] ChannelImage read_channels(const ImageSource& source);

}  // namespace etendue
