// Decoded images, looked up by texture coordinate.
#pragma once

#include "core/rgb.h"
#include "core/vec.h"
#include "image/image.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <variant>
#include <vector>

namespace etendue {

enum class Wrap { Repeat, Mirror, Clamp };

enum class Encoding {
    Linear,  ///< data, or colour that is already linear
    Srgb,    ///< 8-bit colour under the sRGB curve (IEC 61966-2-1); alpha is linear
};

struct TextureOptions {
    Wrap wrap_u = Wrap::Repeat;
    Wrap wrap_v = Wrap::Repeat;
    Encoding encoding = Encoding::Linear;
    bool nearest = false;  ///< no interpolation between texels
};

struct Texel {
    Rgb rgb;  ///< linear, in the image's own primaries
    float alpha = 1.0f;
};

/// Texels in the file's own depth: 1 byte a channel for 8-bit files, 4 for others.
class Texture {
  public:
    Texture(Image8 image, TextureOptions options);
    Texture(ImageF image, TextureOptions options);

    /// Bilinear (or nearest) value at `uv`: (0, 0) is the corner of the first texel of the top row, v grows downwards,
    /// as in glTF. One channel reads as grey, two as grey and alpha. Non-finite coordinates read as (0, 0).
    [[nodiscard]] Texel lookup(Vec2f uv) const;

    /// Mean of rgb and of alpha over all texels, linear.
    [[nodiscard]] Texel mean() const;

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] std::size_t bytes() const;

  private:
    [[nodiscard]] Texel fetch(int x, int y) const;

    int width_ = 0;
    int height_ = 0;
    int channels_ = 0;
    TextureOptions options_;
    std::variant<std::vector<std::uint8_t>, std::vector<float>> texels_;
};

}  // namespace etendue
