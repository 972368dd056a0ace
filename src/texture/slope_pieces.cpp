#include "texture/slope_pieces.h"

#include "core/error.h"
#include "texture/slope_distribution.h"
#include "texture/texture_options.h"

#include <algorithm>
#include <cstddef>
#include <tuple>

namespace etendue {

SlopePieces::SlopePieces(const ImageSource& source, bool interpolated)
    : map_(source, Encoding::Linear), info_(map_.info()), slopes_(map_.info().width, map_.info().height, interpolated) {
    info_.width = std::max(1, info_.width / 2);
    info_.height = std::max(1, info_.height / 2);
    info_.decoded_channels = static_cast<int>(std::tuple_size_v<SlopeMoments>);
    info_.depth = TexelDepth::Float;
    level_ = {info_.width, info_.height};
}

void SlopePieces::read_rows(int, int y_begin, int y_end, std::span<float> values) {
    std::ranges::fill(values, 0.0f);
    const int end_x = std::min(map_.info().width, 2 * level_.width);
    const int end_y = std::min(map_.info().height, 2 * y_end);
    // Of a half-sized texel, what one of the map takes; a side of one texel is not halved.
    const auto share_of = [](int size) { return size > 1 ? 0.5f : 1.0f; };
    const float share = share_of(map_.info().width) * share_of(map_.info().height);
    const auto read = [this](int y, std::span<Vec2f> slopes) { read_slopes(y, slopes); };
    for (int y = 2 * y_begin; y < end_y; ++y)
        for (int x = 0; x < end_x; ++x) {
            const SlopeMoments moments = slopes_.moments(x, y, read);
            const int texel = (y / 2 - y_begin) * level_.width + x / 2;
            float* value = values.data() + static_cast<std::size_t>(texel) * moments.size();
            for (const float moment : moments) *value++ += share * moment;
        }
}

void SlopePieces::read_tile(int, int, int, std::span<float>) {
    throw IoError("slopes are not stored in tiles");
}

void SlopePieces::fetch_row(int y) {
    if (y >= first_row_ && y < end_row_) return;
    const ImageLevel tile = map_.tile();
    const auto width = static_cast<std::size_t>(map_.info().width);
    const auto channels = static_cast<std::size_t>(map_.info().decoded_channels);
    end_row_ = 0;  // none, should reading fail
    if (tile.height == 0) {
        texels_.resize(width * channels);
        map_.read_rows(0, y, y + 1, texels_);
        first_row_ = y;
        end_row_ = y + 1;
        return;
    }
    const auto tile_width = static_cast<std::size_t>(tile.width);
    const auto tile_height = static_cast<std::size_t>(tile.height);
    texels_.resize(width * tile_height * channels);
    tile_.resize(tile_width * tile_height * channels);
    first_row_ = y / tile.height * tile.height;
    for (std::size_t x = 0; x < width; x += tile_width) {
        map_.read_tile(0, static_cast<int>(x), first_row_, tile_);
        const std::size_t columns = std::min(tile_width, width - x);
        for (std::size_t row = 0; row < tile_height; ++row)
            std::copy_n(&tile_[row * tile_width * channels], columns * channels,
                        &texels_[(row * width + x) * channels]);
    }
    end_row_ = first_row_ + tile.height;
}

void SlopePieces::read_slopes(int y, std::span<Vec2f> slopes) {
    fetch_row(y);
    const int channels = map_.info().decoded_channels;
    const float* texel =
        &texels_[static_cast<std::size_t>(y - first_row_) * slopes.size() * static_cast<std::size_t>(channels)];
    for (Vec2f& slope : slopes) {
        slope = slope_of(make_texel(channels, texel).rgb);
        texel += channels;
    }
}

}  // namespace etendue
