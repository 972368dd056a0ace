#include "image/displayed.h"
#include "world/compile_parts.h"

#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <string>

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

MipFilter to_mip_filter(TextureMipFilter filter) {
    switch (filter) {
        case TextureMipFilter::None:
            return MipFilter::None;
        case TextureMipFilter::Nearest:
            return MipFilter::Nearest;
        case TextureMipFilter::Linear:
            return MipFilter::Linear;
    }
    return MipFilter::Linear;
}

/// Floats are linear whatever they are used for.
Encoding encoding_of(TextureUse use, const ImageInfo& info) {
    return use == TextureUse::Color && !info.is_float ? Encoding::Srgb : Encoding::Linear;
}

TextureOptions options_of(const TextureDesc& desc, Encoding encoding) {
    return {.wrap_u = to_wrap(desc.wrap_u),
            .wrap_v = to_wrap(desc.wrap_v),
            .encoding = encoding,
            .nearest = desc.filter == TextureFilter::Nearest,
            .nearest_minified = desc.min_filter == TextureFilter::Nearest,
            .mip_filter = to_mip_filter(desc.mip_filter)};
}

ImageSource source_of(const ImageDesc& image) {
    return image.path.empty() ? ImageSource(std::span<const std::byte>(image.encoded)) : ImageSource(image.path);
}

/// Runs `step`; what it cannot read is blamed on `image`.
template <typename Step>
auto read_or_blame(const ImageDesc& image, const Step& step) {
    try {
        return step();
    } catch (const IoError& error) {
        throw SceneError(image.location, std::string("the image cannot be decoded: ") + error.what());
    }
}

std::uint64_t resident_bytes(TextureUse use, const ImageInfo& info) {
    const std::uint64_t texels = mip_texel_count(info.width, info.height) *
                                 static_cast<std::uint64_t>(info.decoded_channels) * bytes_of(info.depth);
    return use == TextureUse::NormalMap ? texels + slope_covariance_bytes(info.width, info.height) : texels;
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

const ImageDesc& TextureCompiler::image_of(const Request& request) const {
    const TextureDesc& desc = scene_.textures[request.first];
    return scene_.images[static_cast<std::size_t>(desc.image.index)];
}

ImageInfo TextureCompiler::info_of(const Request& request) const {
    const ImageDesc& image = image_of(request);
    return read_or_blame(image, [&] { return read_displayed_info(source_of(image)); });
}

std::uint64_t TextureCompiler::bytes_in_memory() const {
    std::uint64_t bytes = 0;
    for (const Request& request : requests_) bytes += resident_bytes(request.second, info_of(request));
    return bytes;
}

void TextureCompiler::finish(std::uint64_t budget, const ThreadPool& threads, WorldData& data) const {
    std::vector<ImageInfo> infos(requests_.size());
    threads.parallel_for(requests_.size(), [&](std::size_t i, int) { infos[i] = info_of(requests_[i]); });
    std::uint64_t needed = 0;
    for (std::size_t i = 0; i < infos.size(); ++i) needed += resident_bytes(requests_[i].second, infos[i]);
    data.textures.reserve(requests_.size());
    if (needed <= budget)
        load_resident(infos, threads, data);
    else
        open_cached(infos, budget, data);
}

Texture TextureCompiler::load(const Request& request, const ImageInfo& info) const {
    const ImageDesc& image = image_of(request);
    const Encoding encoding = encoding_of(request.second, info);
    return read_or_blame(image, [&] {
        MipChain texels(read_displayed_levels(source_of(image)), encoding);
        const TextureOptions options = options_of(scene_.textures[request.first], encoding);
        if (request.second == TextureUse::NormalMap) texels.keep_slopes(!options.nearest);
        return Texture(std::move(texels), options);
    });
}

void TextureCompiler::load_resident(std::span<const ImageInfo> infos, const ThreadPool& threads,
                                    WorldData& data) const {
    std::vector<std::optional<Texture>> loaded(requests_.size());
    threads.parallel_for(requests_.size(), [&](std::size_t i, int) { loaded[i] = load(requests_[i], infos[i]); });
    for (std::optional<Texture>& texture : loaded) data.textures.push_back(std::move(*texture));
}

void TextureCompiler::open_cached(std::span<const ImageInfo> infos, std::uint64_t budget, WorldData& data) const {
    data.texture_cache = std::make_unique<TextureCache>(budget);
    // Embedded images are copied: the scene does not outlive compilation. Once, however many textures show them.
    std::map<const ImageDesc*, std::shared_ptr<const std::vector<std::byte>>> embedded;
    for (std::size_t i = 0; i < requests_.size(); ++i) {
        if (!fills_display(infos[i])) {
            data.textures.push_back(load(requests_[i], infos[i]));
            continue;
        }
        const ImageDesc& image = image_of(requests_[i]);
        TextureCache::Source source = image.path;
        if (image.path.empty()) {
            auto& bytes = embedded[&image];
            if (!bytes) bytes = std::make_shared<const std::vector<std::byte>>(image.encoded);
            source = bytes;
        }
        const Encoding encoding = encoding_of(requests_[i].second, infos[i]);
        const TextureOptions options = options_of(scene_.textures[requests_[i].first], encoding);
        const CachedImage cached = read_or_blame(image, [&] {
            return requests_[i].second == TextureUse::NormalMap
                       ? data.texture_cache->add_normal_map(source, !options.nearest)
                       : data.texture_cache->add(source, encoding);
        });
        data.textures.emplace_back(cached, options);
    }
}

}  // namespace etendue
