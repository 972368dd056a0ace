// Decoded images, looked up by texture coordinate.
#pragma once

#include "core/vec.h"
#include "texture/footprint.h"
#include "texture/mip_chain.h"
#include "texture/texture_cache.h"
#include "texture/texture_options.h"

#include <cstddef>
#include <optional>
#include <variant>

namespace etendue {

/// An image with the way it is read. Its texels are in memory, or come through a cache; look-ups are the same.
class Texture {
  public:
    Texture(MipChain texels, TextureOptions options);
    Texture(CachedImage texels, TextureOptions options);
    /// `image` alone, for what is only read at points: mip levels would take a third more.
    [[nodiscard]] static Texture without_levels(NativeImage image, const TextureOptions& options);

    /// Value at the point `uv` of the image itself, bilinear or nearest: (0, 0) is the corner of the first texel of the
    /// top row, v grows downwards, as in glTF. One channel reads as grey, two as grey and alpha. Non-finite coordinates
    /// read as (0, 0).
    [[nodiscard]] Texel lookup(Vec2f uv) const;

    /// Has what `lookup` at `uv` in [0, 1)² reads fetched from memory, if it is there.
    void fetch(Vec2f uv) const {
        if (const auto* chain = std::get_if<MipChain>(&texels_)) chain->fetch(uv);
    }

    /// Mean over `footprint` around `uv`, as the options say: of a few taps along the ellipse in mip levels that fit
    /// its width. The same as a point where the footprint is smaller than a texel.
    [[nodiscard]] Texel lookup(Vec2f uv, const TextureFootprint& footprint) const;

    /// How the slopes of a normal map that keeps them are spread over `footprint` around `uv`, along the tangent and
    /// the bitangent. Zero where `lookup` reads a point: within a texel, or as the options say.
    [[nodiscard]] SlopeCovariance slope_covariance(Vec2f uv, const TextureFootprint& footprint) const;

    /// Mean of rgb and of alpha over the image, linear.
    [[nodiscard]] Texel mean() const;
    /// Returns the least and the greatest value of each channel; nothing if its texels come through a cache.
    [[nodiscard]] std::optional<TexelRange> range() const;

    /// Returns the texels if they are 8 bits each in memory and read between texels and between levels; else null.
    [[nodiscard]] const MipChain* usual_texels() const;
    [[nodiscard]] const TextureOptions& options() const { return options_; }

    [[nodiscard]] int width() const;
    [[nodiscard]] int height() const;
    /// Returns the bytes held by the texture itself; none if its texels come through a cache.
    [[nodiscard]] std::size_t bytes() const;

  private:
    /// Where a look-up reads: `taps`, with the level as the options want it.
    struct Plan {
        FilterTaps<float> taps;
        bool nearest;
        bool is_filtered;  ///< false: one tap in the image itself
    };
    template <typename Texels>
    [[nodiscard]] Plan plan(const Texels& texels, const TextureFootprint& footprint) const;

    TextureOptions options_;
    std::variant<MipChain, CachedImage> texels_;
};

}  // namespace etendue
