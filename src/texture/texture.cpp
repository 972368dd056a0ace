#include "texture/texture.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace etendue {

namespace {

std::array<float, 256> make_srgb_table() {
    std::array<float, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i) {
        const double v = static_cast<double>(i) / 255.0;
        table[i] = static_cast<float>(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
    }
    return table;
}

float decode_srgb(std::uint8_t value) {
    static const std::array<float, 256> table = make_srgb_table();
    return table[value];
}

int wrap_index(int i, int size, Wrap wrap) {
    switch (wrap) {
        case Wrap::Clamp:
            return std::clamp(i, 0, size - 1);
        case Wrap::Repeat: {
            const int remainder = i % size;
            return remainder < 0 ? remainder + size : remainder;
        }
        case Wrap::Mirror: {
            const int period = 2 * size;
            int remainder = i % period;
            if (remainder < 0) remainder += period;
            return remainder < size ? remainder : period - 1 - remainder;
        }
    }
    return 0;
}

/// Continuous texel coordinate, kept small enough for integers: coordinates repeat after two sizes at the latest.
float texel_coordinate(float u, int size, Wrap wrap) {
    if (!std::isfinite(u)) return 0.0f;
    const float reduced = wrap == Wrap::Clamp ? std::clamp(u, -1.0f, 2.0f) : u - 2.0f * std::floor(u * 0.5f);
    return reduced * static_cast<float>(size);
}

Texel make_texel(int channels, float c0, float c1, float c2, float c3) {
    switch (channels) {
        case 1:
            return {Rgb(c0), 1.0f};
        case 2:
            return {Rgb(c0), c1};
        case 3:
            return {{c0, c1, c2}, 1.0f};
        default:
            return {{c0, c1, c2}, c3};
    }
}

Texel mix(const Texel& a, const Texel& b, float t) {
    return {lerp(a.rgb, b.rgb, t), a.alpha + (b.alpha - a.alpha) * t};
}

}  // namespace

Texture::Texture(Image8 image, TextureOptions options)
    : width_(image.width),
      height_(image.height),
      channels_(image.channels),
      options_(options),
      texels_(std::move(image.pixels)) {}

Texture::Texture(ImageF image, TextureOptions options)
    : width_(image.width),
      height_(image.height),
      channels_(image.channels),
      options_(options),
      texels_(std::move(image.pixels)) {}

Texel Texture::fetch(int x, int y) const {
    const auto channels = static_cast<std::size_t>(channels_);
    const std::size_t offset =
        (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)) * channels;
    std::array<float, 4> c{};
    if (const auto* bytes = std::get_if<std::vector<std::uint8_t>>(&texels_)) {
        const std::size_t alpha_channel = channels == 2 ? 1 : 3;
        for (std::size_t i = 0; i < channels; ++i) {
            const std::uint8_t value = (*bytes)[offset + i];
            const bool curved = options_.encoding == Encoding::Srgb && i != alpha_channel;
            c[i] = curved ? decode_srgb(value) : static_cast<float>(value) * (1.0f / 255.0f);
        }
    } else {
        const auto& floats = std::get<std::vector<float>>(texels_);
        for (std::size_t i = 0; i < channels; ++i) c[i] = floats[offset + i];
    }
    return make_texel(channels_, c[0], c[1], c[2], c[3]);
}

Texel Texture::lookup(Vec2f uv) const {
    const float x = texel_coordinate(uv.x, width_, options_.wrap_u);
    const float y = texel_coordinate(uv.y, height_, options_.wrap_v);
    const auto wrapped = [this](int ix, int iy) {
        return fetch(wrap_index(ix, width_, options_.wrap_u), wrap_index(iy, height_, options_.wrap_v));
    };
    if (options_.nearest) return wrapped(static_cast<int>(std::floor(x)), static_cast<int>(std::floor(y)));
    // Texel centres lie at half-integers.
    const float left = std::floor(x - 0.5f);
    const float top = std::floor(y - 0.5f);
    const float fx = x - 0.5f - left;
    const float fy = y - 0.5f - top;
    const int ix = static_cast<int>(left);
    const int iy = static_cast<int>(top);
    return mix(mix(wrapped(ix, iy), wrapped(ix + 1, iy), fx), mix(wrapped(ix, iy + 1), wrapped(ix + 1, iy + 1), fx),
               fy);
}

Texel Texture::mean() const {
    double r = 0.0;
    double g = 0.0;
    double b = 0.0;
    double alpha = 0.0;
    for (int y = 0; y < height_; ++y) {
        for (int x = 0; x < width_; ++x) {
            const Texel t = fetch(x, y);
            r += static_cast<double>(t.rgb.r);
            g += static_cast<double>(t.rgb.g);
            b += static_cast<double>(t.rgb.b);
            alpha += static_cast<double>(t.alpha);
        }
    }
    const double scale = 1.0 / (static_cast<double>(width_) * static_cast<double>(height_));
    return {{static_cast<float>(r * scale), static_cast<float>(g * scale), static_cast<float>(b * scale)},
            static_cast<float>(alpha * scale)};
}

std::size_t Texture::bytes() const {
    const std::size_t count =
        static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) * static_cast<std::size_t>(channels_);
    return count * (std::holds_alternative<std::vector<float>>(texels_) ? sizeof(float) : sizeof(std::uint8_t));
}

}  // namespace etendue
