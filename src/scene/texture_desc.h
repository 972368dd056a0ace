// Images, samplers and references to textures, as a scene file names them. No pixels are decoded here.
#pragma once

#include "core/error.h"
#include "core/vec.h"
#include "scene/handle.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace etendue {

/// An encoded image: a file, or bytes from a buffer view or a data URI. Exactly one of the two is set, unless it is
/// unreadable.
struct ImageDesc {
    std::string name;
    std::filesystem::path path;      ///< resolved and inside the scene directory; empty if `encoded` is used
    std::vector<std::byte> encoded;  ///< bytes of an image file as they stood in the scene's
    std::string mime_type;           ///< "image/png", "image/jpeg", or empty if the file did not say
    int width = 0;                   ///< pixels, from the image's header
    int height = 0;                  ///< pixels, from the image's header
    bool unreadable = false;         ///< missing or broken: there is neither path nor bytes, and nothing shows it
    SourceLocation location;
};

enum class TextureWrap { Repeat, MirroredRepeat, ClampToEdge };
enum class TextureFilter { Nearest, Linear };
/// Between the levels of a mip chain; None reads the image itself however small it is shown.
enum class TextureMipFilter { None, Nearest, Linear };

/// An image with the sampler it is read through.
struct TextureDesc {
    std::string name;
    Handle<ImageDesc> image;
    TextureWrap wrap_u = TextureWrap::Repeat;
    TextureWrap wrap_v = TextureWrap::Repeat;
    TextureFilter filter = TextureFilter::Linear;      ///< the sampler's magnification filter
    TextureFilter min_filter = TextureFilter::Linear;  ///< filter where the texture is minified, within a level
    TextureMipFilter mip_filter = TextureMipFilter::Linear;
    SourceLocation location;
};

/// KHR_texture_transform: uv' = T(offset) R(rotation) S(scale) uv.
struct TextureTransform {
    Vec2f offset{0.0f, 0.0f};
    float rotation = 0.0f;  ///< radians, counter-clockwise in uv space as the extension defines it
    Vec2f scale{1.0f, 1.0f};

    friend bool operator==(const TextureTransform&, const TextureTransform&) = default;
};

/// A material's slot: which texture, with which coordinates. Whether it is colour or data is the slot's business.
struct TextureRef {
    Handle<TextureDesc> texture;
    int texcoord = 0;  ///< 0 or 1
    TextureTransform transform;

    [[nodiscard]] bool valid() const { return texture.valid(); }
};

}  // namespace etendue
