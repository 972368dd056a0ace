// An image as OpenImageIO's cache sees it. For this room only.
#pragma once

#include "image/image_pieces.h"
#include "texture/tile_cache.h"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <OpenImageIO/imageio.h>

namespace etendue::oiio {

/// Reads what an OpenPieces opens, which must outlive it.
class SourceInput final : public OIIO::ImageInput {
  public:
    /// Name of the attribute that passes the pointer to the OpenPieces through the cache to `open`.
    static constexpr const char* kOpenAttribute = "etendue:open";

    /// Makes an input for OpenImageIO, which owns the result.
    [[nodiscard]] static OIIO::ImageInput* create() { return new SourceInput; }

    [[nodiscard]] const char* format_name() const override { return "etendue"; }
    bool open(const std::string& name, OIIO::ImageSpec& spec) override;
    bool open(const std::string& name, OIIO::ImageSpec& spec, const OIIO::ImageSpec& config) override;
    bool close() override;
    [[nodiscard]] int current_miplevel() const override { return level_; }
    bool seek_subimage(int subimage, int level) override;
    bool read_native_scanline(int subimage, int level, int y, int z, void* data) override;
    bool read_native_scanlines(int subimage, int level, int y_begin, int y_end, int z, void* data) override;
    bool read_native_tile(int subimage, int level, int x, int y, int z, void* data) override;

  private:
    template <typename Read>
    bool convert(std::size_t pixel_count, void* data, const Read& read);

    std::unique_ptr<ImagePieces> pieces_;
    int level_ = 0;
    std::vector<float> values_;
};

}  // namespace etendue::oiio
