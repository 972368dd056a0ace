#include "image/read.h"
#include "world/compile_parts.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace etendue {

namespace {

Wrap to_wrap(TextureWrap wrap) {
    switch (wrap) {
        case TextureWrap::Repeat:
            return Wrap::Repeat;
        case TextureWrap::MirroredRepeat:
            return Wrap::Mirror;
        case TextureWrap::ClampToEdge:
            return Wrap::Clamp;
    }
    return Wrap::Repeat;
}

float linear_from_srgb(float v) {
    return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

/// Deep integer files under the sRGB curve are linearised once; 8-bit ones keep their bytes and are decoded when read.
void linearize(ImageF& image) {
    const int color_channels = image.channels == 2 ? 1 : std::min(image.channels, 3);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (int c = 0; c < color_channels; ++c) {
                float& value = image.pixel(x, y)[static_cast<std::size_t>(c)];
                value = linear_from_srgb(value);
            }
}

Texture decode_texture(const SceneDesc& scene, const TextureDesc& desc, TextureUse use) {
    const ImageDesc& image = scene.images[static_cast<std::size_t>(desc.image.index)];
    const ImageSource source =
        image.path.empty() ? ImageSource(std::span<const std::byte>(image.encoded)) : ImageSource(image.path);
    TextureOptions options{.wrap_u = to_wrap(desc.wrap_u),
                           .wrap_v = to_wrap(desc.wrap_v),
                           .encoding = use == TextureUse::Color ? Encoding::Srgb : Encoding::Linear,
                           .nearest = desc.filter == TextureFilter::Nearest};
    try {
        const ImageInfo info = read_image_info(source);
        if (info.bits_per_channel <= 8 && !info.is_float) return {read_image_8bit(source), options};
        ImageF pixels = read_image_float(source);
        if (use == TextureUse::Color && !info.is_float) linearize(pixels);
        options.encoding = Encoding::Linear;
        return {std::move(pixels), options};
    } catch (const IoError& error) {
        throw SceneError(image.location, std::string("the image cannot be decoded: ") + error.what());
    }
}

}  // namespace

TextureSlot TextureCompiler::slot(const TextureRef& ref, TextureUse use) {
    TextureSlot slot;
    if (!ref.valid()) return slot;
    const Request request{static_cast<std::size_t>(ref.texture.index), use};
    const auto [entry, is_new] = index_of_.try_emplace(request, requests_.size());
    if (is_new) requests_.push_back(request);
    slot.texture = static_cast<std::int32_t>(entry->second);
    slot.texcoord = ref.texcoord;
    // KHR_texture_transform: translation * rotation * scale, with its own sense of rotation.
    const TextureTransform& t = ref.transform;
    const float c = std::cos(t.rotation);
    const float s = std::sin(t.rotation);
    slot.row0 = {c * t.scale.x, s * t.scale.y, t.offset.x};
    slot.row1 = {-s * t.scale.x, c * t.scale.y, t.offset.y};
    return slot;
}

std::vector<Texture> TextureCompiler::decode(const ThreadPool& threads) const {
    std::vector<std::optional<Texture>> decoded(requests_.size());
    threads.parallel_for(requests_.size(), [&](std::size_t i, int) {
        decoded[i] = decode_texture(scene_, scene_.textures[requests_[i].first], requests_[i].second);
    });
    std::vector<Texture> textures;
    textures.reserve(decoded.size());
    for (std::optional<Texture>& texture : decoded) textures.push_back(std::move(*texture));
    return textures;
}

}  // namespace etendue
