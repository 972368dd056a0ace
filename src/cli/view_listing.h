// What there is to view with, and to view: displays, views, looks, and the layers of a file.
#pragma once

#include "color/color_config.h"
#include "image/layers.h"

#include <optional>
#include <string>

namespace etendue {

struct ViewedFile {
    std::string path;
    LayeredImage image;
    std::string color_space;  ///< colour space of the main layer, as `space_of_file` says it
};

/// Lists the displays and views of `colors`, and the layers of `file` if there is a file, as lines of text.
[[nodiscard]] std::string list_as_text(const ColorConfig& colors, const std::optional<ViewedFile>& file);
/// Lists the displays, views and looks of `colors`, and the layers of `file` if there is a file, as a JSON object.
[[nodiscard]] std::string list_as_json(const ColorConfig& colors, const std::optional<ViewedFile>& file);

/// "colour", "luminance", "vector" or "channel".
[[nodiscard]] const char* layer_kind_name(LayerKind kind);

}  // namespace etendue
