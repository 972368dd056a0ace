// How a texture is read: what its sampler and the use of its image say.
#pragma once

#include "core/rgb.h"

namespace etendue {

enum class Wrap { Repeat, Mirror, Clamp };

enum class Encoding {
    Linear,  ///< data, or colour that is already linear
    Srgb,    ///< colour under the sRGB curve (IEC 61966-2-1); alpha is linear
};

/// Says what happens between the levels of a mip chain where the texture is minified.
enum class MipFilter {
    None,     ///< the image itself is read, at one point: aliases unless there are many samples
    Nearest,  ///< the level nearest to the footprint
    Linear,   ///< between two levels
};

struct TextureOptions {
    Wrap wrap_u = Wrap::Repeat;
    Wrap wrap_v = Wrap::Repeat;
    Encoding encoding = Encoding::Linear;
    bool nearest = false;           ///< no interpolation between texels where the texture is magnified
    bool nearest_minified = false;  ///< no interpolation between texels of a level where it is minified
    MipFilter mip_filter = MipFilter::Linear;
};

struct Texel {
    Rgb rgb;  ///< linear, in the image's own primaries
    float alpha = 1.0f;

    /// Not trivial, so that it is returned in memory. In registers, of which each holds two numbers, GCC 12 puts it
    /// together through memory, number by number, and the processor waits for what it has just stored.
    ~Texel() {}  // NOLINT(modernize-use-equals-default)
};

[[nodiscard]] inline Texel operator+(const Texel& a, const Texel& b) {
    return {a.rgb + b.rgb, a.alpha + b.alpha};
}
[[nodiscard]] inline Texel operator*(const Texel& a, float s) {
    return {a.rgb * s, a.alpha * s};
}

/// Makes a texel from values: one channel reads as grey, two as grey and alpha. `c` has at least `channels` values.
[[nodiscard]] inline Texel make_texel(int channels, const float* c) {
    switch (channels) {
        case 1:
            return {Rgb(c[0]), 1.0f};
        case 2:
            return {Rgb(c[0]), c[1]};
        case 3:
            return {{c[0], c[1], c[2]}, 1.0f};
        default:
            return {{c[0], c[1], c[2]}, c[3]};
    }
}

/// True if channel `c` of `channels` is alpha, which no curve applies to.
[[nodiscard]] constexpr bool is_alpha(int c, int channels) {
    return c == (channels == 2 ? 1 : 3);
}

}  // namespace etendue
