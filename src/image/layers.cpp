#include "image/layers.h"

#include "image/encoded_image.h"
#include "image/image_functions.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace etendue {

LayeredImage read_layers(const ImageSource& source) {
    const EncodedImage image = look_at(source);
    return image_functions().read_layers(image);
}

std::optional<ImageLayer> find_layer(const LayeredImage& image, std::string_view name) {
    const auto found = std::ranges::find(image.layers, name, &ImageLayer::name);
    if (found != image.layers.end()) return *found;
    for (const ImageLayer& layer : image.layers)
        for (std::size_t i = 0; i < layer.channels.size(); ++i) {
            if (layer.channels[i] != name) continue;
            ImageLayer one = layer;
            one.name = name;
            one.kind = LayerKind::Single;
            one.channels = {layer.channels[i]};
            one.indices = {layer.indices[i]};
            return one;
        }
    return std::nullopt;
}

std::optional<ImageLayer> main_layer(const LayeredImage& image) {
    for (const LayerKind kind : {LayerKind::Color, LayerKind::Luminance}) {
        const auto found = std::ranges::find(image.layers, kind, &ImageLayer::kind);
        if (found != image.layers.end()) return *found;
    }
    if (image.layers.empty()) return std::nullopt;
    return image.layers.front();
}

ImageF read_layer(const ImageSource& source, const ImageLayer& layer) {
    const EncodedImage image = look_at(source);
    ImageF pixels = image_functions().read_layer(image, layer);
    return image.radiance ? developed(std::move(pixels), *image.radiance) : pixels;
}

}  // namespace etendue
