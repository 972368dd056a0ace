#include "texture/texture_cache.h"

#include "core/error.h"
#include "texture/mip_chain.h"
#include "texture/source_input.h"
#include "texture/wrap.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <mutex>

#include <OpenImageIO/imagecache.h>
#include <OpenImageIO/texture.h>
#include <fmt/format.h>

namespace etendue {

namespace {

struct DestroyTextureSystem {
    void operator()(OIIO::TextureSystem* system) const { OIIO::TextureSystem::destroy(system); }
};

OIIO::TextureOpt::Wrap to_library(Wrap wrap) {
    switch (wrap) {
        case Wrap::Repeat:
            return OIIO::TextureOpt::WrapPeriodic;
        case Wrap::Mirror:
            return OIIO::TextureOpt::WrapMirror;
        case Wrap::Clamp:
            return OIIO::TextureOpt::WrapClamp;
    }
    return OIIO::TextureOpt::WrapPeriodic;
}

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

}  // namespace

struct TextureCache::Impl {
    std::uint64_t budget = 0;
    std::vector<std::unique_ptr<CacheEntry>> entries;  // outlive `system`, which reads from them
    std::unique_ptr<OIIO::TextureSystem, DestroyTextureSystem> system;

    mutable std::atomic<std::uint64_t> failed_lookups{0};
    mutable std::mutex failure_mutex;
    mutable std::string first_failure;

    void count_failure() const {
        const std::string message = system->geterror();
        if (failed_lookups.fetch_add(1, std::memory_order_relaxed) > 0) return;
        const std::lock_guard lock(failure_mutex);
        first_failure = message;
    }
};

Texel CachedImage::sample(Vec2f uv, float level, bool nearest, const TextureOptions& options) const {
    OIIO::TextureOpt opt;
    opt.swrap = to_library(options.wrap_u);
    opt.twrap = to_library(options.wrap_v);
    opt.mipmode = OIIO::TextureOpt::MipModeTrilinear;
    opt.interpmode = nearest ? OIIO::TextureOpt::InterpClosest : OIIO::TextureOpt::InterpBilinear;
    const float width = width_for_level(level, width_, height_, level_count_);
    const TextureCache::Impl& impl = *cache_->impl_;
    std::array<float, 4> values{};
    const bool found =
        impl.system->texture(static_cast<OIIO::TextureSystem::TextureHandle*>(handle_), nullptr, opt,
                             reduce_coordinate(uv.x, options.wrap_u), reduce_coordinate(uv.y, options.wrap_v), width,
                             0.0f, 0.0f, width, channels_, values.data());
    if (!found) {
        impl.count_failure();
        return {Rgb(), 0.0f};
    }
    return make_texel(channels_, values.data());
}

Texel CachedImage::mean() const {
    return sample({0.5f, 0.5f}, static_cast<float>(level_count_ - 1), false, {});
}

TextureCache::TextureCache(std::uint64_t budget) : impl_(std::make_unique<Impl>()) {
    impl_->budget = budget;
    impl_->system.reset(OIIO::TextureSystem::create(false));
    OIIO::TextureSystem& system = *impl_->system;
    system.attribute("max_memory_MB", static_cast<float>(static_cast<double>(budget) / (1024.0 * 1024.0)));
    system.attribute("autotile", 64);
    system.attribute("automip", 1);
}

TextureCache::~TextureCache() = default;

CachedImage TextureCache::add(Source source, Encoding encoding) {
    auto entry = std::make_unique<CacheEntry>(CacheEntry{std::move(source), encoding});
    const OIIO::ustring name(fmt::format("texture {}", impl_->entries.size()));
    void* pointer = entry.get();
    impl_->entries.push_back(std::move(entry));
    OIIO::ImageSpec config;
    config.attribute(SourceInput::kEntryAttribute, OIIO::TypeDesc::PTR, &pointer);
    OIIO::TextureSystem& system = *impl_->system;
    system.imagecache()->add_file(name, &SourceInput::create, &config);

    CachedImage image;
    image.cache_ = this;
    image.handle_ = system.get_texture_handle(name);
    OIIO::ImageSpec spec;
    if (!system.get_imagespec(name, 0, spec)) throw IoError(system.geterror());
    image.width_ = spec.width;
    image.height_ = spec.height;
    image.channels_ = spec.nchannels;
    image.level_count_ = mip_level_count(spec.width, spec.height);
    return image;
}

std::uint64_t TextureCache::budget() const {
    return impl_->budget;
}

std::uint64_t TextureCache::bytes() const {
    long long bytes = 0;
    impl_->system->getattribute("stat:cache_memory_used", OIIO::TypeDesc::INT64, &bytes);
    return static_cast<std::uint64_t>(bytes);
}

std::uint64_t TextureCache::failed_lookups() const {
    return impl_->failed_lookups.load();
}

std::string TextureCache::first_failure() const {
    const std::lock_guard lock(impl_->failure_mutex);
    return impl_->first_failure;
}

}  // namespace etendue
