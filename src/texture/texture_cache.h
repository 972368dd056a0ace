// Textures that stay in their files: OpenImageIO's texture system reads the tiles that look-ups ask for and forgets
// those that no one asked for lately.
//
// It sees every image through a reader of ours (source_input.h), which decodes colour to linear light. So the mip
// levels that the cache makes of images without any are averaged in linear light, like those of MipChain, and embedded
// images and files whose suffix lies are read as everywhere else.
#pragma once

#include "core/vec.h"
#include "image/read.h"
#include "texture/slope_distribution.h"
#include "texture/texture_options.h"
#include "texture/tile_cache.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace etendue {

class TextureCache;

/// An image whose texels come through a cache, which must outlive it.
class CachedImage {
  public:
    /// Returns the filtered texel at `uv` as MipChain does; where a file's pixels prove broken it is zero, and the
    /// cache counts it.
    [[nodiscard]] Texel sample(Vec2f uv, float level, bool nearest, const TextureOptions& options) const;
    /// Returns the slopes of an image that was added as a normal map, as MipChain does.
    [[nodiscard]] SlopeDistribution sample_slopes(Vec2f uv, float level, bool nearest,
                                                  const TextureOptions& options) const;
    /// Returns the texel of the image's coarsest mip level: near the mean over all texels.
    [[nodiscard]] Texel mean() const;

    [[nodiscard]] int width() const { return texels_.width; }
    [[nodiscard]] int height() const { return texels_.height; }

  private:
    friend class TextureCache;

    /// Writes as many values as `image` has channels; false, and counted, where its pixels prove broken.
    [[nodiscard]] bool look_up(const TileImage& image, Vec2f uv, float level, bool nearest,
                               const TextureOptions& options, float* values) const;

    const TextureCache* cache_ = nullptr;
    TileImage texels_;
    TileImage slopes_;       ///< SlopePieces, of a normal map
    TileImage times_alpha_;  ///< holds colours times alpha, if means are taken by alpha
};

class TextureCache {
  public:
    /// A file, or an encoded image in memory.
    using Source = std::variant<std::filesystem::path, std::shared_ptr<const std::vector<std::byte>>>;

    /// Holds at most about `budget` bytes of decoded tiles, at least 10 MiB.
    explicit TextureCache(std::uint64_t budget);
    ~TextureCache();
    TextureCache(const TextureCache&) = delete;
    TextureCache& operator=(const TextureCache&) = delete;

    /// Opens the image. Throws IoError if its header is broken. Not while look-ups are made.
    [[nodiscard]] CachedImage add(Source source, Encoding encoding);
    /// Adds an image whose colours, where it is minified, are means with alpha as their weight.
    [[nodiscard]] CachedImage add_by_alpha(const Source& source, Encoding encoding);
    /// Adds a normal map, whose slopes are kept as MipChain keeps them.
    [[nodiscard]] CachedImage add_normal_map(const Source& source, bool interpolated);

    [[nodiscard]] std::uint64_t budget() const;
    /// Returns the bytes of the decoded tiles that are held now.
    [[nodiscard]] std::uint64_t bytes() const;
    /// Look-ups that met broken pixels, and what the first of them was told.
    [[nodiscard]] std::uint64_t failed_lookups() const;
    [[nodiscard]] std::string first_failure() const;

  private:
    friend class CachedImage;
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace etendue
