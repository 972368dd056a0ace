// Layers of an image file: the sets of channels that belong together, in one part of the file or in several.
#pragma once

#include "image/read.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

enum class LayerKind {
    Color,      ///< R, G, B and perhaps A
    Luminance,  ///< Y and perhaps A
    Vector,     ///< X, Y, Z, or X, Y, or U, V
    Single,     ///< any one channel
};

struct ImageLayer {
    /// Names the layer: the part of its channels' names before the last dot ("diffuse.R"), or the whole name of a
    /// channel without one or without fellows; empty for plain R, G, B and A of a file that has one part. In a file of
    /// several, the part's name comes before it, or is all there is. No two layers of a file have the same.
    std::string name;
    LayerKind kind = LayerKind::Single;
    int part = 0;
    std::vector<std::string> channels{};  ///< whole names, in the order of `kind`
    std::vector<int> indices{};           ///< indices of the channels in the part
    bool is_integer = false;              ///< counts, such as ids, rather than floats
    std::string problem{};                ///< why it cannot be read; empty if it can
};

struct LayeredImage {
    std::vector<ImageInfo> parts;
    std::vector<ImageLayer> layers;  ///< part by part, in the order of the file's channels
    /// Names of Cryptomattes as their metadata have them: the ranks of NAME are layers of channels NAME00.R, NAME00.G …
    std::vector<std::string> mattes{};
};

/// Reads the headers only. Throws IoError as `read_image_info` does; a part that cannot be read is a `problem` of its
/// layers.
[[nodiscard]] LayeredImage read_layers(const ImageSource& source);

/// The layer of this name, or a layer of the one channel of this name; none if there is neither.
[[nodiscard]] std::optional<ImageLayer> find_layer(const LayeredImage& image, std::string_view name);

/// The first layer of colours, or else the first; none if there are no channels.
[[nodiscard]] std::optional<ImageLayer> main_layer(const LayeredImage& image);

/// Decodes the channels of `layer`, which was found in this file, as `read_image_float` does. Throws IoError.
[[nodiscard]] ImageF read_layer(const ImageSource& source, const ImageLayer& layer);

}  // namespace etendue
