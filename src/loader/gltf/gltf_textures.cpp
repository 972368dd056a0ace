#include "loader/gltf/gltf_textures.h"

#include "core/refused_input.h"
#include "core/shown_text.h"
#include "image/displayed.h"
#include "loader/files.h"
#include "loader/gltf/gltf_buffers.h"
#include "loader/gltf/gltf_value.h"
#include "loader/json_text.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

TextureWrap wrap_of(int code) {
    switch (code) {
        case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
            return TextureWrap::ClampToEdge;
        case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
            return TextureWrap::MirroredRepeat;
        default:
            return TextureWrap::Repeat;
    }
}

/// Sets the filters with which `texture` is minified from the glTF `code` of a sampler; trilinear if `code` says
/// nothing.
void read_min_filter(int code, TextureDesc& texture) {
    switch (code) {
        case TINYGLTF_TEXTURE_FILTER_NEAREST:
        case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST:
        case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR:
            texture.min_filter = TextureFilter::Nearest;
            break;
        default:
            texture.min_filter = TextureFilter::Linear;
    }
    switch (code) {
        case TINYGLTF_TEXTURE_FILTER_NEAREST:
        case TINYGLTF_TEXTURE_FILTER_LINEAR:
            texture.mip_filter = TextureMipFilter::None;
            break;
        case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST:
        case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST:
            texture.mip_filter = TextureMipFilter::Nearest;
            break;
        default:
            texture.mip_filter = TextureMipFilter::Linear;
    }
}

std::vector<std::byte> to_bytes(std::span<const unsigned char> source) {
    const auto bytes = std::as_bytes(source);
    return {bytes.begin(), bytes.end()};
}

/// "image file 'x.png': ", if it is one.
std::string file_name(const GltfImage& source) {
    if (source.buffer_view || is_data_uri(source.uri)) return {};
    return fmt::format("image file '{}': ", shown(source.uri));
}

/// Stands for an image that cannot be read.
ImageDesc unreadable_image(const std::string& name, const SourceLocation& where) {
    ImageDesc image;
    image.name = name;
    image.location = where;
    image.unreadable = true;
    return image;
}

}  // namespace

TextureReader::TextureReader(const GltfDocument& document, AccessorReader& accessors, SceneDesc& scene,
                             ProblemList& problems)
    : document_(document), accessors_(accessors), scene_(scene), problems_(problems) {}

Handle<TextureDesc> TextureReader::texture(int index) {
    if (index < 0 || static_cast<std::size_t>(index) >= document_.model.textures.size()) return {};
    const auto key = static_cast<std::size_t>(index);
    const auto known = textures_.find(key);
    if (known != textures_.end()) return known->second;
    return textures_[key] = read_texture(key);
}

Handle<TextureDesc> TextureReader::read_texture(std::size_t index) {
    const tinygltf::Texture& source = document_.model.textures[index];
    const SourceLocation where = document_.at(fmt::format("/textures/{}", index));
    int image_index = source.source;
    if (const tinygltf::Value* webp = find_extension(source.extensions, "EXT_texture_webp"))
        image_index = integer_or(*webp, "source", image_index);
    if (image_index < 0) {
        std::string extensions;
        for (const auto& [name, value] : source.extensions)
            extensions += (extensions.empty() ? "" : ", ") + shown(name);
        if (extensions.empty()) {
            problems_.warning(where, "the texture has no image: what uses it does without");
            return {};
        }
        extensions = "the texture's only image comes from an extension that is not supported: " + extensions;
        if (scene_.settings.missing_textures == MissingTextures::Error) {
            problems_.error(where, extensions);
            return {};
        }
        problems_.warning(where, extensions + "; materials do without it");
    }
    const Handle<ImageDesc> pixels = image_index < 0 ? add_image(unreadable_image(source.name, where))
                                                     : image(static_cast<std::size_t>(image_index));
    if (!pixels) return {};

    TextureDesc texture;
    texture.name = source.name;
    texture.image = pixels;
    texture.location = where;
    if (source.sampler >= 0 && static_cast<std::size_t>(source.sampler) < document_.model.samplers.size()) {
        const tinygltf::Sampler& sampler = document_.model.samplers[static_cast<std::size_t>(source.sampler)];
        texture.wrap_u = wrap_of(sampler.wrapS);
        texture.wrap_v = wrap_of(sampler.wrapT);
        const bool nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
        texture.filter = nearest ? TextureFilter::Nearest : TextureFilter::Linear;
        read_min_filter(sampler.minFilter, texture);
    }
    scene_.textures.push_back(std::move(texture));
    return {static_cast<std::int32_t>(scene_.textures.size()) - 1};
}

Handle<ImageDesc> TextureReader::image(std::size_t index) {
    if (index >= document_.images.size()) return {};
    const auto known = images_.find(index);
    if (known != images_.end()) return known->second;
    Handle<ImageDesc> handle;
    if (std::optional<ImageDesc> image = read_image(index)) handle = add_image(std::move(*image));
    return images_[index] = handle;
}

Handle<ImageDesc> TextureReader::add_image(ImageDesc image) {
    scene_.images.push_back(std::move(image));
    return {static_cast<std::int32_t>(scene_.images.size() - 1)};
}

Handle<ImageDesc> TextureReader::required_image(std::size_t index) {
    const Handle<ImageDesc> handle = image(index);
    if (!handle || !scene_.images[static_cast<std::size_t>(handle.index)].unreadable) return handle;
    problems_.error(document_.at(fmt::format("/images/{}", index)), "the environment cannot do without this image");
    return {};
}

std::optional<ImageDesc> TextureReader::read_image(std::size_t index) {
    const GltfImage& source = document_.images[index];
    ImageDesc image;
    image.name = source.name;
    image.mime_type = source.mime_type;
    image.location = document_.at(fmt::format("/images/{}", index));
    try {
        if (!take_pixels(source, image)) return std::nullopt;
        const ImageInfo info = image.path.empty() ? read_displayed_info(std::span<const std::byte>(image.encoded))
                                                  : read_displayed_info(image.path);
        if (info.format != "png" && info.format != "jpeg" && info.format != "webp") {
            problems_.warning(image.location,
                              fmt::format("glTF images are PNG, JPEG or (EXT_texture_webp) WebP; this one is {}, which "
                                          "is read, but not by every program",
                                          info.format));
        }
        if (!source.mime_type.empty() && source.mime_type != "image/" + info.format)
            problems_.warning(image.location, fmt::format("is {}, whatever its mimeType '{}' says", info.format,
                                                          shown(source.mime_type)));
        image.width = info.width;
        image.height = info.height;
    } catch (const RefusedInput& error) {
        problems_.error(image.location, file_name(source) + error.what());
        return std::nullopt;
    } catch (const IoError& error) {
        if (scene_.settings.missing_textures == MissingTextures::Error) {
            problems_.error(image.location, file_name(source) + error.what());
            return std::nullopt;
        }
        problems_.warning(image.location,
                          fmt::format("{}{}; materials do without it", file_name(source), error.what()));
        return unreadable_image(source.name, image.location);
    }
    if (!image.path.empty() && std::ranges::find(scene_.inputs, image.path) == scene_.inputs.end())
        scene_.inputs.push_back(image.path);
    return image;
}

bool TextureReader::take_pixels(const GltfImage& source, ImageDesc& image) {
    if (source.buffer_view) {
        const auto bytes = accessors_.copyable_view(*source.buffer_view, image.location);
        if (!bytes) return false;
        image.encoded = to_bytes(*bytes);
    } else if (is_data_uri(source.uri)) {
        const auto bytes = decode_data_uri(source.uri);
        if (!bytes) throw IoError("the data URI is empty or not base64");
        image.encoded = to_bytes(*bytes);
    } else {
        image.path = resolve_uri(document_.directory, source.uri);
    }
    return true;
}

}  // namespace etendue
