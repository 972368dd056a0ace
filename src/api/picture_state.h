// What a Picture holds.
#pragma once

#include "color/color_config.h"
#include "picture/image_description.h"

#include <filesystem>
#include <vector>

#include <etendue/picture.h>

namespace etendue {

struct Picture::State {
    ImageDescription image;
    ColorConfig colors;
    std::vector<std::filesystem::path> inputs;  ///< files of the scene that no output may replace
    std::vector<Message> messages;
    std::vector<Layer> layers;  ///< layers of `image`, as the caller sees them

    /// Fills `layers` with those of `image`.
    void list_layers();
};

}  // namespace etendue
