#include "core/error.h"
#include "oiio/functions.h"
#include "oiio/open_image.h"

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace etendue::oiio {

namespace {

class DecodedPieces final : public ImagePieces {
  public:
    explicit DecodedPieces(const EncodedImage& encoded)
        : encoded_(encoded), image_(open_image(encoded)), info_(describe(image_)), levels_(levels_of(image_)) {
        const OIIO::ImageSpec& spec = image_.spec;
        if (spec.tile_width > 0 && spec.tile_height > 0 && spec.tile_depth == 1)
            tile_ = {spec.tile_width, spec.tile_height};
    }

    [[nodiscard]] const ImageInfo& info() const override { return info_; }
    [[nodiscard]] std::span<const ImageLevel> levels() const override { return levels_; }
    [[nodiscard]] ImageLevel tile() const override { return tile_; }

    void read_rows(int level, int y_begin, int y_end, std::span<float> values) override {
        require_whole();
        if (y_begin < next_row_ && !reads_in_any_order()) reopen();
        next_row_ = y_end;
        const ImageLevel& size = levels_[static_cast<std::size_t>(level)];
        seek_level(image_, size, level);
        // The library counts rows from where the image lies in its canvas.
        const int first_row = image_.input->spec().y;
        const auto width = static_cast<std::size_t>(size.width);
        const std::size_t pixel_count = width * static_cast<std::size_t>(y_end - y_begin);
        float* const pixels = target_of(pixel_count, values);
        finish(oiio::read_rows(*image_.input, first_row + y_begin, first_row + y_end, target(level, pixels)),
               pixel_count, values);
    }

    void read_tile(int level, int x, int y, std::span<float> values) override {
        require_whole();
        seek_level(image_, levels_[static_cast<std::size_t>(level)], level);
        const OIIO::ImageSpec live = image_.input->spec();
        const auto [width, height] = tile_;
        if (live.tile_width != width || live.tile_height != height) throw IoError("its levels have different tiles");
        x += live.x;
        y += live.y;
        const std::size_t pixel_count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
        float* const pixels = target_of(pixel_count, values);
        finish(oiio::read_tiles(*image_.input, x, y, tile_, target(level, pixels)), pixel_count, values);
    }

  private:
    /// Throws IoError if reading has failed before: the library may have closed the file, and would not look before it
    /// reads on.
    void require_whole() const {
        if (is_broken_) throw IoError("the pixels are broken");
    }
    /// Returns whether rows may be read in any order. For a row before the last one read, the library opens formats
    /// that are decoded from the first row on again, without what was asked of it and not at all in memory.
    [[nodiscard]] bool reads_in_any_order() const { return image_.format.name == "openexr"; }
    void reopen() { const OpenImage former = std::exchange(image_, open_image(encoded_)); }
    /// Returns where `pixel_count` pixels are to be read to: `values` itself if the channels stand right in the file.
    float* target_of(std::size_t pixel_count, std::span<float> values) {
        if (channels_in_order(image_)) return values.data();
        stored_.resize(pixel_count * channel_range(image_).size());
        return stored_.data();
    }

    [[nodiscard]] PixelTarget target(int level, float* pixels) const {
        return {image_.part, level, channel_range(image_), OIIO::TypeDesc::FLOAT, pixels};
    }

    void finish(bool are_read, std::size_t pixel_count, std::span<float> values) {
        is_broken_ = !are_read;
        if (is_broken_) throw_library_error(*image_.input, "the pixels are broken");
        if (!channels_in_order(image_)) pick_channels(image_, stored_.data(), pixel_count, values.data());
    }

    EncodedImage encoded_;
    OpenImage image_;
    int next_row_ = 0;  ///< after the last that was read
    bool is_broken_ = false;
    ImageInfo info_;
    std::vector<ImageLevel> levels_;
    ImageLevel tile_;
    std::vector<float> stored_;  ///< pixels with channels that are not wanted, or in another order
};

}  // namespace

std::unique_ptr<ImagePieces> open_pieces(const EncodedImage& image) {
    return std::make_unique<DecodedPieces>(image);
}

}  // namespace etendue::oiio
