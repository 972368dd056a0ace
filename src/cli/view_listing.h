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
    std::string color_space;  ///< of the main layer, as `space_of_file` says it
};

/// As lines of text. `file` may be missing.
[[nodiscard]] std::string list_as_text(const ColorConfig& colors, const std::optional<ViewedFile>& file);
/// As a JSON object.
[[nodiscard]] std::string list_as_json(const ColorConfig& colors, const std::optional<ViewedFile>& file);

/// "colour", "luminance", "vector" or "channel".
[[nodiscard]] const char* layer_kind_name(LayerKind kind);

}  // namespace etendue
