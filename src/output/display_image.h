// A scene-linear image as a display shows it.
#pragma once

#include "color/color_config.h"
#include "image/image.h"
#include "image/write.h"

#include <string>
#include <vector>

namespace etendue {

/// Says how scene-linear pixels come to a display.
struct DisplayView {
    std::string working_space;
    std::string display;    ///< empty for the config's default
    std::string view;       ///< empty for the display's default
    std::string look{};     ///< as `ColorConfig::display_transform` takes it; empty for the view's own
    float exposure = 0.0f;  ///< stops
};

/// Returns `view` with the config's defaults in place of what is empty.
[[nodiscard]] DisplayView with_defaults(DisplayView view, const ColorConfig& config);

/// Returns three channels in [0, 1], encoded for the display, of `image`, which has three, or four with associated
/// alpha: that one over black. Throws IoError for other images, SceneError if the config lacks a name.
[[nodiscard]] ImageF display_image(const ImageF& image, const DisplayView& view, const ColorConfig& config);

/// Returns what a PNG of an image that was made by `view` says of the view; `view` has no empty names.
[[nodiscard]] std::vector<ImageAttribute> display_attributes(const DisplayView& view);

}  // namespace etendue
