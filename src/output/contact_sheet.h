// Many small images on one sheet, each with its label.
#pragma once

#include "image/image.h"

#include <string>
#include <vector>

namespace etendue {

struct LabelledImage {
    std::string label;  ///< digits, commas, spaces and parentheses are drawn; other characters leave a gap
    ImageF pixels;      ///< three channels in [0, 1], encoded for a display
};

/// Rows of images from the left, labels beneath, on dark grey: three channels in [0, 1]. All images have one size.
/// Throws std::invalid_argument if they have not, or there is none.
[[nodiscard]] ImageF make_contact_sheet(const std::vector<std::vector<LabelledImage>>& rows);

}  // namespace etendue
