#include "core/refused_input.h"
#include "image/displayed.h"
#include "image/finite.h"
#include "image/image_reader.h"
#include "image/jpeg.h"
#include "image/read.h"
#include "world/compile_parts.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

#include <fmt/format.h>

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
    const bool is_color = use == TextureUse::Color || use == TextureUse::ColorByAlpha;
    return is_color && !info.is_float ? Encoding::Srgb : Encoding::Linear;
}

TextureOptions options_of(const TextureDesc& desc, Encoding encoding) {
    return {.wrap_u = to_wrap(desc.wrap_u),
            .wrap_v = to_wrap(desc.wrap_v),
            .encoding = encoding,
            .nearest = desc.filter == TextureFilter::Nearest,
            .nearest_minified = desc.min_filter == TextureFilter::Nearest,
            .mip_filter = to_mip_filter(desc.mip_filter)};
}

/// "the image 'a.exr'", as messages call it.
std::string name_of(const ImageDesc& image) {
    return image.path.empty() ? "the image" : "the image '" + image.path.filename().string() + "'";
}

SceneError cannot_be_decoded(const ImageDesc& image, const IoError& error) {
    return {image.location, fmt::format("{} cannot be decoded: {}", name_of(image), error.what())};
}

/// Runs `step`; what it cannot read is blamed on `image`.
template <typename Step>
auto read_or_blame(const ImageDesc& image, const Step& step) {
    try {
        return step();
    } catch (const IoError& error) {
        throw cannot_be_decoded(image, error);
    }
}

/// Puts right what is no number in the image itself; of integers, nothing.
RepairedValues make_finite(NativeImage& image) {
    return std::visit(
        [](auto& pixels) -> RepairedValues {
            using Value = typename std::decay_t<decltype(pixels.pixels)>::value_type;
            if constexpr (std::is_integral_v<Value>)
                return {};
            else
                return etendue::make_finite(std::span(pixels.pixels));
        },
        image);
}

/// The rows of an image before the first that is broken, whose place the last of them takes.
struct WholeRows {
    ImageF image;
    int count = 0;
};

WholeRows read_whole_rows(const ImageSource& source) {
    ImageReader reader(source);
    WholeRows rows{ImageF(reader.info().width, reader.info().height, reader.info().decoded_channels)};
    if (reader.tile().width > 0) return rows;
    const std::size_t length = rows.image.pixels.size() / static_cast<std::size_t>(rows.image.height);
    const auto row = [&](int y) {
        return std::span(rows.image.pixels).subspan(static_cast<std::size_t>(y) * length, length);
    };
    try {
        for (; rows.count < rows.image.height; ++rows.count)
            reader.read_rows(0, rows.count, rows.count + 1, row(rows.count));
    } catch (const IoError&) {
        for (int y = rows.count; y < rows.image.height && rows.count > 0; ++y)
            std::ranges::copy(row(rows.count - 1), row(y).begin());
    }
    return rows;
}

/// Counts what of an image is no number, without keeping it; nothing of integers, nor from where its pixels are broken.
RepairedValues count_repairs(const ImageSource& source) {
    RepairedValues repaired;
    ImageReader reader(source);
    const ImageInfo& info = reader.info();
    if (info.depth != TexelDepth::Half && info.depth != TexelDepth::Float) return repaired;
    const ImageLevel tile = reader.tile();
    const bool is_tiled = tile.width > 0;
    const int columns = is_tiled ? tile.width : info.width;
    const int rows = is_tiled ? tile.height : 1;
    const auto channels = static_cast<std::size_t>(info.decoded_channels);
    std::vector<float> values(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows) * channels);
    try {
        for (int y = 0; y < info.height; y += rows)
            for (int x = 0; x < info.width; x += columns) {
                if (is_tiled)
                    reader.read_tile(0, x, y, values);
                else
                    reader.read_rows(0, y, y + 1, values);
                // What of a tile lies beyond the image counts for nothing.
                const auto length = static_cast<std::size_t>(std::min(columns, info.width - x)) * channels;
                for (int row = 0; row < std::min(rows, info.height - y); ++row) {
                    const std::size_t first =
                        static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) * channels;
                    const RepairedValues found = etendue::make_finite(std::span(values).subspan(first, length));
                    repaired.infinite += found.infinite;
                    repaired.no_number += found.no_number;
                }
            }
    } catch (const IoError&) {
        return repaired;
    }
    return repaired;
}

std::uint64_t resident_bytes(TextureUse use, const ImageInfo& info) {
    // While it is decoded, what lies beyond the display window takes memory, too.
    const std::uint64_t most =
        std::max<std::uint64_t>(mip_texel_count(info.width, info.height), info.data_window.area());
    const std::uint64_t texels = most * static_cast<std::uint64_t>(info.decoded_channels) * bytes_of(info.depth);
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
    return read_displayed_info(source_of(image_of(request)));
}

std::uint64_t TextureCompiler::bytes_in_memory() const {
    std::uint64_t bytes = 0;
    for (const Request& request : requests_)
        bytes += resident_bytes(request.second, read_or_blame(image_of(request), [&] { return info_of(request); }));
    return bytes;
}

template <typename Step>
std::vector<std::size_t> TextureCompiler::for_each_request(const ThreadPool& threads, ProblemList& problems,
                                                           const Step& step) const {
    std::vector<std::string> failures(requests_.size());
    threads.parallel_for(requests_.size(), [&](std::size_t i, int) {
        try {
            step(i);
        } catch (const RefusedInput& error) {
            throw cannot_be_decoded(image_of(requests_[i]), error);
        } catch (const IoError& error) {
            if (scene_.settings.missing_textures == MissingTextures::Error)
                throw cannot_be_decoded(image_of(requests_[i]), error);
            failures[i] = error.what();
        }
    });
    std::vector<std::size_t> unreadable;
    for (std::size_t i = 0; i < requests_.size(); ++i) {
        if (failures[i].empty()) continue;
        const ImageDesc& image = image_of(requests_[i]);
        const auto index = static_cast<std::size_t>(&image - scene_.images.data());
        if (std::ranges::find(unreadable, index) != unreadable.end()) continue;
        unreadable.push_back(index);
        problems.warning(image.location,
                         fmt::format("{} cannot be decoded: {}; materials do without it", name_of(image), failures[i]));
    }
    return unreadable;
}

namespace {

/// Bytes of textures that may be kept whatever the budget for them is.
constexpr std::uint64_t kAlwaysResident = std::uint64_t{256} << 20;

/// Returns true if an image is so long that the cache, whose look-ups go by the shorter side, would not find its
/// coarser levels.
bool is_strip(const ImageInfo& info) {
    constexpr int kLongest = 16;
    return std::max(info.width, info.height) >= kLongest * std::min(info.width, info.height);
}

}  // namespace

void TextureCompiler::warn_of_cut_images(std::span<const std::uint8_t> is_cut, ProblemList& problems) const {
    std::set<const ImageDesc*> cut;
    for (std::size_t i = 0; i < requests_.size(); ++i) {
        const ImageDesc& image = image_of(requests_[i]);
        if (is_cut[i] != 1 || !cut.insert(&image).second) continue;
        const std::string message = fmt::format("the data of {} ends early", name_of(image));
        if (scene_.settings.missing_textures == MissingTextures::Error)
            problems.error(image.location, message);
        else
            problems.warning(image.location, message + ": the rest of it is made up");
    }
}

std::vector<std::size_t> TextureCompiler::finish(std::uint64_t budget, const ThreadPool& threads, WorldData& data,
                                                 ProblemList& problems) {
    std::vector<ImageInfo> infos(requests_.size());
    std::vector<std::uint8_t> is_cut(requests_.size());
    std::vector<std::size_t> unreadable = for_each_request(threads, problems, [&](std::size_t i) {
        infos[i] = info_of(requests_[i]);
        is_cut[i] = is_cut_jpeg(source_of(image_of(requests_[i]))) ? 1 : 0;
    });
    if (unreadable.empty()) {
        std::uint64_t needed = 0;
        for (std::size_t i = 0; i < infos.size(); ++i) needed += resident_bytes(requests_[i].second, infos[i]);
        data.textures.reserve(requests_.size());
        if (needed <= budget)
            unreadable = load_resident(infos, threads, data, problems);
        else
            open_cached(infos, budget, data, problems);
    }
    if (unreadable.empty()) {
        warn_of_cut_images(is_cut, problems);
        return {};
    }
    requests_.clear();
    index_of_.clear();
    return unreadable;
}

TextureCompiler::Loaded TextureCompiler::load(const Request& request, const ImageInfo& info) const {
    const ImageSource source = source_of(image_of(request));
    std::vector<NativeImage> levels;
    int whole_rows = info.height;
    try {
        levels = read_displayed_levels(source);
    } catch (const RefusedInput&) {
        throw;
    } catch (const IoError&) {
        if (scene_.settings.missing_textures == MissingTextures::Error || !fills_display(info)) throw;
        WholeRows rows = read_whole_rows(source);
        whole_rows = rows.count;
        if (whole_rows == 0) throw;
        levels.emplace_back(std::move(rows.image));
    }
    const RepairedValues repaired = make_finite(levels.front());
    const Encoding encoding = encoding_of(request.second, info);
    MipChain texels(std::move(levels), encoding,
                    request.second == TextureUse::ColorByAlpha ? MipLevels::AllByAlpha : MipLevels::All);
    const TextureOptions options = options_of(scene_.textures[request.first], encoding);
    if (request.second == TextureUse::NormalMap) texels.keep_slopes(!options.nearest);
    return {Texture(std::move(texels), options), repaired, whole_rows};
}

std::vector<std::size_t> TextureCompiler::load_resident(std::span<const ImageInfo> infos, const ThreadPool& threads,
                                                        WorldData& data, ProblemList& problems) {
    std::vector<std::optional<Loaded>> loaded(requests_.size());
    std::vector<std::size_t> unreadable = for_each_request(threads, problems, [&](std::size_t i) {
        if (!loaded_.contains(requests_[i])) loaded[i] = load(requests_[i], infos[i]);
    });
    for (std::size_t i = 0; i < requests_.size(); ++i)
        if (loaded[i]) loaded_.emplace(requests_[i], std::move(*loaded[i]));
    if (!unreadable.empty()) return unreadable;
    std::set<const ImageDesc*> reported;
    for (const Request& request : requests_) {
        Loaded& made = loaded_.at(request);
        const ImageDesc& image = image_of(request);
        if (reported.insert(&image).second) {
            warn_of_repairs(made.repaired, name_of(image), image.location, problems);
            if (made.whole_rows < image.height)
                problems.warning(image.location,
                                 fmt::format("the data of {} is cut off or broken from row {} of {} on: "
                                             "the row before takes the place of the rest",
                                             name_of(image), made.whole_rows, image.height));
        }
        data.textures.push_back(std::move(made.texture));
    }
    return {};
}

void TextureCompiler::open_cached(std::span<const ImageInfo> infos, std::uint64_t budget, WorldData& data,
                                  ProblemList& problems) const {
    data.texture_cache = std::make_unique<TextureCache>(budget);
    // Embedded images are copied: the scene does not outlive compilation. Once, however many textures show them.
    std::map<const ImageDesc*, std::shared_ptr<const std::vector<std::byte>>> embedded;
    std::set<const ImageDesc*> reported;
    std::uint64_t resident = 0;
    for (std::size_t i = 0; i < requests_.size(); ++i) {
        const ImageDesc& image = image_of(requests_[i]);
        if (reported.insert(&image).second)
            warn_of_repairs(read_or_blame(image, [&] { return count_repairs(source_of(image)); }), name_of(image),
                            image.location, problems);
        if (!fills_display(infos[i]) || is_strip(infos[i])) {
            resident += resident_bytes(requests_[i].second, infos[i]);
            if (resident > std::max(budget, kAlwaysResident))
                throw SceneError(image.location,
                                 "the textures that cannot be read piece by piece, strips and those with a window of "
                                 "their own, take more than --texture-memory");
            data.textures.push_back(
                read_or_blame(image, [&] { return std::move(load(requests_[i], infos[i]).texture); }));
            continue;
        }
        TextureCache::Source source = image.path;
        if (image.path.empty()) {
            auto& bytes = embedded[&image];
            if (!bytes) bytes = std::make_shared<const std::vector<std::byte>>(image.encoded);
            source = bytes;
        }
        const Encoding encoding = encoding_of(requests_[i].second, infos[i]);
        const TextureOptions options = options_of(scene_.textures[requests_[i].first], encoding);
        const CachedImage cached = read_or_blame(image, [&] {
            switch (requests_[i].second) {
                case TextureUse::NormalMap:
                    return data.texture_cache->add_normal_map(source, !options.nearest);
                case TextureUse::ColorByAlpha:
                    return data.texture_cache->add_by_alpha(source, encoding);
                case TextureUse::Color:
                case TextureUse::Data:
                    break;
            }
            return data.texture_cache->add(source, encoding);
        });
        data.textures.emplace_back(cached, options);
    }
}

}  // namespace etendue
