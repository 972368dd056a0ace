// The cache of tiles behind TextureCache, which is OpenImageIO's. For the rooms texture and oiio.
#pragma once

#include "image/image_pieces.h"
#include "image/read.h"
#include "texture/texture_options.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace etendue {

/// Opens an image as the cache is to see it: what its ImageInfo says of depth and channels is how its tiles are held.
/// Called again whenever the cache has closed it. Throws IoError.
using OpenPieces = std::function<std::unique_ptr<ImagePieces>()>;

/// An image in a cache.
struct TileImage {
    void* handle = nullptr;
    int width = 0;
    int height = 0;
    int channels = 0;
};

/// Where and how an image is read.
struct TileLookup {
    float u = 0.0f;
    float v = 0.0f;
    float width = 0.0f;  ///< width of the filter, in texture coordinates
    Wrap wrap_u = Wrap::Repeat;
    Wrap wrap_v = Wrap::Repeat;
    bool nearest = false;  ///< else bilinear, and linear between levels
};

class TileCache {
  public:
    virtual ~TileCache() = default;

    /// Opens an image for look-ups, as TextureCache::add does.
    [[nodiscard]] virtual TileImage add(OpenPieces open) = 0;
    /// Writes as many values as the image has channels; false, with an `error`, if its pixels are broken. On any number
    /// of threads.
    virtual bool look_up(const TileImage& image, const TileLookup& lookup, float* values) const = 0;
    /// Returns the last error that this thread was told, and forgets it.
    [[nodiscard]] virtual std::string error() const = 0;
    /// Returns the bytes of the tiles that are held now.
    [[nodiscard]] virtual std::uint64_t bytes() const = 0;
};

/// A cache of about `budget` bytes.
using MakeTileCache = std::unique_ptr<TileCache>(std::uint64_t budget);

/// The name under which the module of image formats exports a pointer to one.
inline constexpr const char* kMakeTileCacheSymbol = "etendue_make_tile_cache";

}  // namespace etendue
