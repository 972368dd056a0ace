#include "core/error.h"
#include "oiio/functions.h"
#include "oiio/source_input.h"

#include <memory>
#include <utility>
#include <vector>

#include <OpenImageIO/imagecache.h>
#include <OpenImageIO/texture.h>
#include <fmt/format.h>

namespace etendue::oiio {

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

class LibraryCache final : public TileCache {
  public:
    explicit LibraryCache(std::uint64_t budget) : system_(OIIO::TextureSystem::create(false)) {
        system_->attribute("max_memory_MB", static_cast<float>(static_cast<double>(budget) / (1024.0 * 1024.0)));
        system_->attribute("autotile", 64);
        system_->attribute("automip", 1);
    }

    [[nodiscard]] TileImage add(OpenPieces open) override {
        const OIIO::ustring name(fmt::format("texture {}", images_.size()));
        images_.push_back(std::make_unique<const OpenPieces>(std::move(open)));
        const void* const pointer = images_.back().get();
        OIIO::ImageSpec config;
        config.attribute(SourceInput::kOpenAttribute, OIIO::TypeDesc::PTR, &pointer);
        system_->imagecache()->add_file(name, &SourceInput::create, &config);

        void* const handle = system_->get_texture_handle(name);
        OIIO::ImageSpec spec;
        if (!system_->get_imagespec(name, 0, spec)) throw IoError(system_->geterror());
        return {handle, spec.width, spec.height, spec.nchannels};
    }

    bool look_up(const TileImage& image, const TileLookup& lookup, float* values) const override {
        OIIO::TextureOpt opt;
        opt.swrap = to_library(lookup.wrap_u);
        opt.twrap = to_library(lookup.wrap_v);
        opt.mipmode = OIIO::TextureOpt::MipModeTrilinear;
        opt.interpmode = lookup.nearest ? OIIO::TextureOpt::InterpClosest : OIIO::TextureOpt::InterpBilinear;
        return system_->texture(static_cast<OIIO::TextureSystem::TextureHandle*>(image.handle), nullptr, opt, lookup.u,
                                lookup.v, lookup.width, 0.0f, 0.0f, lookup.width, image.channels, values);
    }

    [[nodiscard]] std::string error() const override { return system_->geterror(); }

    [[nodiscard]] std::uint64_t bytes() const override {
        long long bytes = 0;
        system_->getattribute("stat:cache_memory_used", OIIO::TypeDesc::INT64, &bytes);
        return static_cast<std::uint64_t>(bytes);
    }

  private:
    std::vector<std::unique_ptr<const OpenPieces>> images_;  // outlives `system_`, which reads from them
    std::unique_ptr<OIIO::TextureSystem, DestroyTextureSystem> system_;
};

}  // namespace

std::unique_ptr<TileCache> make_tile_cache(std::uint64_t budget) {
    return std::make_unique<LibraryCache>(budget);
}

}  // namespace etendue::oiio
