// Small images and textures made from them.
#pragma once

#include "texture/texture.h"

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace etendue::test {

[[nodiscard]] inline double srgb_to_linear(int value) {
    const double v = value / 255.0;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

[[nodiscard]] inline Image8 bytes(int width, int height, int channels, std::vector<std::uint8_t> pixels) {
    Image8 image(width, height, channels);
    image.pixels = std::move(pixels);
    return image;
}

[[nodiscard]] inline MipChain make_chain(NativeImage image, Encoding encoding) {
    std::vector<NativeImage> levels;
    levels.push_back(std::move(image));
    return {std::move(levels), encoding};
}

[[nodiscard]] inline Texture make_texture(NativeImage image, TextureOptions options) {
    return {make_chain(std::move(image), options.encoding), options};
}

}  // namespace etendue::test
