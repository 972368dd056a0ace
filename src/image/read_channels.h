// All channels of an image with many layers, and all that its header says of them.
#pragma once

#include "image/read.h"
#include "image/write.h"

#include <string>
#include <string_view>
#include <vector>

namespace etendue {

struct ChannelImage {
    ImageF pixels;                           ///< all channels
    std::vector<std::string> channel_names;  ///< one for each, unlike all others; layers are written "layer.R"
    std::vector<PixelDepth> depths;          ///< depth of each channel, Half or Float
    PixelRect data_window;                   ///< where the pixels lie, as in ImageInfo
    PixelRect display_window;
    /// Holds the attributes that `write_image` can write again: numbers, texts, matrices and eight floats of
    /// chromaticities, but not those that say how the file is stored.
    std::vector<ImageAttribute> attributes;

    /// The attribute of that name, or nothing.
    [[nodiscard]] const ImageAttribute* find(std::string_view name) const;
};

/// At most so many channels are read of one file.
inline constexpr int kMostChannels = 4096;

/// Reads all parts of an OpenEXR file, which must have the same data window, or an image of another format whose
/// channels are floats. What the header of an earlier part says goes before that of a later one. Throws IoError as
/// `read_image_info` does, and if a channel holds integers, two have one name or there are more than kMostChannels.
[[nodiscard]] ChannelImage read_channels(const ImageSource& source);

}  // namespace etendue
