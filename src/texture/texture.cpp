#include "texture/texture.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace etendue {

Texture::Texture(MipChain texels, TextureOptions options) : options_(options), texels_(std::move(texels)) {}

Texture::Texture(CachedImage texels, TextureOptions options) : options_(options), texels_(texels) {}

Texture Texture::without_levels(NativeImage image, const TextureOptions& options) {
    std::vector<NativeImage> levels;
    levels.push_back(std::move(image));
    return {MipChain(std::move(levels), options.encoding, MipLevels::AsGiven), options};
}

Texel Texture::lookup(Vec2f uv) const {
    return std::visit([&](const auto& texels) { return texels.sample(uv, 0.0f, options_.nearest, options_); }, texels_);
}

template <typename Texels>
Texture::Plan Texture::plan(const Texels& texels, const TextureFootprint& footprint) const {
    FilterTaps<float> taps = plan_taps(footprint.diameter[0], footprint.diameter[1],
                                       {static_cast<float>(texels.width()), static_cast<float>(texels.height())});
    if (!taps.minified) return {{}, options_.nearest, false};
    if (options_.mip_filter == MipFilter::None) return {{}, options_.nearest_minified, false};
    if (options_.mip_filter == MipFilter::Nearest) taps.level = std::round(taps.level);
    return {taps, options_.nearest_minified, true};
}

Texel Texture::lookup(Vec2f uv, const TextureFootprint& footprint) const {
    if (footprint.is_point()) return lookup(uv);
    const auto filter = [&](const auto& texels) {
        const auto [taps, nearest, is_filtered] = plan(texels, footprint);
        const int count = static_cast<int>(taps.count);
        if (count == 1) return texels.sample(uv, taps.level, nearest, options_);
        Texel sum{Rgb(), 0.0f};
        Vec2f at = uv - taps.step * (0.5f * (taps.count - 1.0f));
        for (int i = 0; i < count; ++i, at += taps.step) sum = sum + texels.sample(at, taps.level, nearest, options_);
        return sum * (1.0f / taps.count);
    };
    return std::visit(filter, texels_);
}

// Within the image itself a normal map is one surface, whose normals are interpolated: no spread until a footprint is
// longer than a texel, and then as much of the first mip level's as is read of that.
SlopeCovariance Texture::slope_covariance(Vec2f uv, const TextureFootprint& footprint) const {
    if (footprint.is_point()) return {};
    const auto filter = [&](const auto& texels) -> SlopeCovariance {
        const auto [taps, nearest, is_filtered] = plan(texels, footprint);
        if (!is_filtered) return {};
        const float from_levels = std::min(taps.level, 1.0f);
        SlopeDistribution sum;
        Vec2f at = uv - taps.step * (0.5f * (taps.count - 1.0f));
        for (int i = 0; i < static_cast<int>(taps.count); ++i, at += taps.step) {
            SlopeDistribution tap;
            if (from_levels < 1.0f) tap.mean = slope_of(texels.sample(at, 0.0f, nearest, options_).rgb);
            if (from_levels > 0.0f)
                tap = mix(tap, texels.sample_slopes(at, std::max(taps.level, 1.0f), nearest, options_), from_levels);
            sum = mix(sum, tap, 1.0f / static_cast<float>(i + 1));
        }
        return sum.covariance;
    };
    return std::visit(filter, texels_);
}

const MipChain* Texture::usual_texels() const {
    const MipChain* resident = std::get_if<MipChain>(&texels_);
    const bool is_usual = !options_.nearest && !options_.nearest_minified && options_.mip_filter == MipFilter::Linear;
    return resident != nullptr && resident->is_8bit() && is_usual ? resident : nullptr;
}

Texel Texture::mean() const {
    return std::visit([](const auto& texels) { return texels.mean(); }, texels_);
}

std::optional<TexelRange> Texture::range() const {
    const auto* const chain = std::get_if<MipChain>(&texels_);
    return chain != nullptr ? std::optional(chain->range()) : std::nullopt;
}

int Texture::width() const {
    return std::visit([](const auto& texels) { return texels.width(); }, texels_);
}

int Texture::height() const {
    return std::visit([](const auto& texels) { return texels.height(); }, texels_);
}

std::size_t Texture::bytes() const {
    const MipChain* resident = std::get_if<MipChain>(&texels_);
    return resident ? resident->bytes() : 0;
}

}  // namespace etendue
