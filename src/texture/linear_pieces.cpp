#include "texture/linear_pieces.h"

#include "image/finite.h"
#include "texture/mip_chain.h"
#include "texture/srgb.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace etendue {

LinearPieces::LinearPieces(const ImageSource& source, Encoding encoding, bool times_alpha)
    : reader_(source),
      encoding_(encoding),
      times_alpha_(times_alpha),
      info_(reader_.info()),
      levels_(reader_.levels()) {
    if ((encoding == Encoding::Srgb || times_alpha) && info_.depth != TexelDepth::Float) info_.depth = TexelDepth::Half;
    if (static_cast<int>(levels_.size()) != mip_level_count(info_.width, info_.height)) levels_ = levels_.first(1);
}

void LinearPieces::read_rows(int level, int y_begin, int y_end, std::span<float> values) {
    reader_.read_rows(level, y_begin, y_end, values);
    linearize(values);
}

void LinearPieces::read_tile(int level, int x, int y, std::span<float> values) {
    reader_.read_tile(level, x, y, values);
    linearize(values);
}

void LinearPieces::linearize(std::span<float> values) const {
    (void)make_finite(values);
    if (encoding_ == Encoding::Srgb) decode(values);
    if (!times_alpha_) return;
    const auto channels = static_cast<std::size_t>(info_.decoded_channels);
    for (std::size_t i = 0; i < values.size(); i += channels) {
        const auto texel = values.subspan(i, channels);
        texel.back() = std::clamp(texel.back(), 0.0f, 1.0f);
        for (float& color : texel.first(channels - 1)) color *= texel.back();
    }
}

void LinearPieces::decode(std::span<float> values) const {
    const int channels = info_.decoded_channels;
    const bool is_8bit = reader_.info().depth == TexelDepth::UInt8;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (is_alpha(static_cast<int>(i % static_cast<std::size_t>(channels)), channels)) continue;
        values[i] = is_8bit ? linear_from_srgb8(static_cast<std::uint8_t>(std::lround(values[i] * 255.0f)))
                            : linear_from_srgb(values[i]);
    }
}

}  // namespace etendue
