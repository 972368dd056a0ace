#include "texture/texture_cache.h"

#include "image/image_module.h"
#include "texture/linear_pieces.h"
#include "texture/mip_chain.h"
#include "texture/slope_pieces.h"
#include "texture/tile_cache.h"
#include "texture/wrap.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <mutex>
#include <span>
#include <utility>

namespace etendue {

namespace {

/// The filter width, in texture coordinates, from which OpenImageIO's trilinear look-up concludes `level`: with the
/// smaller side of level m as measure, it reads between the levels m - 1 and m where the width is (1 + t) / 2 texels of
/// level m, t being the share of level m.
float width_for_level(float level, int width, int height, int level_count) {
    if (level <= 0.0f) return 0.0f;
    const auto coarser = static_cast<int>(std::ceil(level));
    if (coarser >= level_count) return 1.0f;
    const float share = 1.0f - (static_cast<float>(coarser) - level);
    const int side = std::max(1, std::min(width >> coarser, height >> coarser));
    return (1.0f + share) / (2.0f * static_cast<float>(side));
}

ImageSource to_image_source(const TextureCache::Source& source) {
    if (const auto* path = std::get_if<std::filesystem::path>(&source)) return *path;
    return std::span<const std::byte>(*std::get<1>(source));
}

std::unique_ptr<TileCache> make_tile_cache(std::uint64_t budget) {
    const auto* const make = static_cast<MakeTileCache* const*>(image_module_symbol(kMakeTileCacheSymbol));
    return (*make)(budget);
}

}  // namespace

struct TextureCache::Impl {
    std::uint64_t budget = 0;
    std::unique_ptr<TileCache> tiles;

    mutable std::atomic<std::uint64_t> failed_lookups{0};
    mutable std::mutex failure_mutex;
    mutable std::string first_failure;

    void count_failure() const {
        const std::string message = tiles->error();
        if (failed_lookups.fetch_add(1, std::memory_order_relaxed) > 0) return;
        const std::lock_guard lock(failure_mutex);
        first_failure = message;
    }
};

bool CachedImage::look_up(const TileImage& image, Vec2f uv, float level, bool nearest, const TextureOptions& options,
                          float* values) const {
    const int level_count = mip_level_count(image.width, image.height);
    const TileLookup lookup{.u = reduce_coordinate(uv.x, options.wrap_u),
                            .v = reduce_coordinate(uv.y, options.wrap_v),
                            .width = width_for_level(level, image.width, image.height, level_count),
                            .wrap_u = options.wrap_u,
                            .wrap_v = options.wrap_v,
                            .nearest = nearest};
    const TextureCache::Impl& impl = *cache_->impl_;
    if (impl.tiles->look_up(image, lookup, values)) return true;
    impl.count_failure();
    return false;
}

Texel CachedImage::sample(Vec2f uv, float level, bool nearest, const TextureOptions& options) const {
    std::array<float, 4> values{};
    if (level > 0.0f && times_alpha_.handle != nullptr) {
        if (!look_up(times_alpha_, uv, level, nearest, options, values.data())) return {Rgb(), 0.0f};
        const Texel product = make_texel(texels_.channels, values.data());
        if (product.alpha > 0.0f) return {product.rgb * (1.0f / product.alpha), product.alpha};
    }
    if (!look_up(texels_, uv, level, nearest, options, values.data())) return {Rgb(), 0.0f};
    return make_texel(texels_.channels, values.data());
}

SlopeDistribution CachedImage::sample_slopes(Vec2f uv, float level, bool nearest, const TextureOptions& options) const {
    SlopeMoments moments{};
    if (!look_up(slopes_, uv, level - 1.0f, nearest, options, moments.data())) return {};
    return distribution_of(moments);
}

Texel CachedImage::mean() const {
    const int level_count = mip_level_count(width(), height());
    return sample({0.5f, 0.5f}, static_cast<float>(level_count - 1), false, {});
}

TextureCache::TextureCache(std::uint64_t budget) : impl_(std::make_unique<Impl>()) {
    impl_->budget = budget;
    impl_->tiles = make_tile_cache(budget);
}

TextureCache::~TextureCache() = default;

CachedImage TextureCache::add(Source source, Encoding encoding) {
    CachedImage image;
    image.cache_ = this;
    image.texels_ = impl_->tiles->add([source = std::move(source), encoding] {
        return std::make_unique<LinearPieces>(to_image_source(source), encoding);
    });
    return image;
}

CachedImage TextureCache::add_by_alpha(const Source& source, Encoding encoding) {
    CachedImage image = add(source, encoding);
    const int channels = image.texels_.channels;
    if (is_alpha(channels - 1, channels))
        image.times_alpha_ = impl_->tiles->add([source, encoding] {
            constexpr bool kTimesAlpha = true;
            return std::make_unique<LinearPieces>(to_image_source(source), encoding, kTimesAlpha);
        });
    return image;
}

CachedImage TextureCache::add_normal_map(const Source& source, bool interpolated) {
    CachedImage image = add(source, Encoding::Linear);
    image.slopes_ = impl_->tiles->add(
        [source, interpolated] { return std::make_unique<SlopePieces>(to_image_source(source), interpolated); });
    return image;
}

std::uint64_t TextureCache::budget() const {
    return impl_->budget;
}

std::uint64_t TextureCache::bytes() const {
    return impl_->tiles->bytes();
}

std::uint64_t TextureCache::failed_lookups() const {
    return impl_->failed_lookups.load();
}

std::string TextureCache::first_failure() const {
    const std::lock_guard lock(impl_->failure_mutex);
    return impl_->first_failure;
}

}  // namespace etendue
