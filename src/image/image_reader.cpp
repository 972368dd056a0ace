#include "image/image_reader.h"

#include "core/error.h"
#include "image/open_image.h"

namespace etendue {

struct ImageReader::Impl {
    OpenImage image;
    ImageInfo info;
    std::vector<ImageLevel> levels;
    ImageLevel tile;
    std::vector<float> stored;  ///< pixels with channels that are not wanted, or in another order

    /// Where `pixel_count` pixels are to be read to: `values` itself if the channels stand right in the file.
    float* target(std::size_t pixel_count, std::span<float> values) {
        if (channels_in_order(image)) return values.data();
        stored.resize(pixel_count * channel_range(image).size());
        return stored.data();
    }

    void finish(bool read, std::size_t pixel_count, std::span<float> values) {
        if (!read) throw_library_error(*image.input, "the pixels are broken");
        if (!channels_in_order(image)) pick_channels(image, stored.data(), pixel_count, values.data());
    }
};

ImageReader::ImageReader(const ImageSource& source) : impl_(std::make_unique<Impl>()) {
    impl_->image = open_image(source);
    impl_->info = describe(impl_->image);
    impl_->levels = levels_of(impl_->image);
    const OIIO::ImageSpec& spec = impl_->image.spec;
    if (spec.tile_width > 0 && spec.tile_height > 0 && spec.tile_depth == 1)
        impl_->tile = {spec.tile_width, spec.tile_height};
}

ImageReader::~ImageReader() = default;
ImageReader::ImageReader(ImageReader&&) noexcept = default;
ImageReader& ImageReader::operator=(ImageReader&&) noexcept = default;

const ImageInfo& ImageReader::info() const {
    return impl_->info;
}

std::span<const ImageLevel> ImageReader::levels() const {
    return impl_->levels;
}

ImageLevel ImageReader::tile() const {
    return impl_->tile;
}

void ImageReader::read_rows(int level, int y_begin, int y_end, std::span<float> values) {
    const ImageLevel& size = impl_->levels[static_cast<std::size_t>(level)];
    seek_level(impl_->image, size, level);
    // The library counts rows from where the image lies in its canvas.
    const int first_row = impl_->image.input->spec().y;
    const auto width = static_cast<std::size_t>(size.width);
    const std::size_t pixel_count = width * static_cast<std::size_t>(y_end - y_begin);
    const ChannelRange range = channel_range(impl_->image);
    float* const target = impl_->target(pixel_count, values);
    const bool read =
        impl_->image.input->read_scanlines(impl_->image.part, level, first_row + y_begin, first_row + y_end, 0,
                                           range.first, range.last, OIIO::TypeDesc::FLOAT, target);
    impl_->finish(read, pixel_count, values);
}

void ImageReader::read_tile(int level, int x, int y, std::span<float> values) {
    seek_level(impl_->image, impl_->levels[static_cast<std::size_t>(level)], level);
    const OIIO::ImageSpec live = impl_->image.input->spec();
    const auto [width, height] = impl_->tile;
    if (live.tile_width != width || live.tile_height != height) throw IoError("its levels have different tiles");
    x += live.x;
    y += live.y;
    const std::size_t pixel_count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    const ChannelRange range = channel_range(impl_->image);
    float* const target = impl_->target(pixel_count, values);
    const bool read = impl_->image.input->read_tiles(impl_->image.part, level, x, x + width, y, y + height, 0, 1,
                                                     range.first, range.last, OIIO::TypeDesc::FLOAT, target);
    impl_->finish(read, pixel_count, values);
}

}  // namespace etendue
