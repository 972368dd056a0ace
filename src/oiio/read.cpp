#include "oiio/functions.h"
#include "oiio/open_image.h"

namespace etendue::oiio {

namespace {

template <typename T>
Image<T> read_level(OpenImage& open, const ImageLevel& size, int level) {
    seek_level(open, size, level);
    Image<T> image(size.width, size.height, static_cast<int>(open.channels.size()));
    const std::size_t pixel_count = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
    const ChannelRange range = channel_range(open);
    const bool in_order = channels_in_order(open);
    std::vector<T> stored(in_order ? 0 : pixel_count * range.size());
    T* const pixels = in_order ? image.pixels.data() : stored.data();
    if (!read_pixels(*open.input, {open.part, level, range, OIIO::BaseTypeFromC<T>::value, pixels}))
        throw_library_error(*open.input, "the pixels are broken");
    if (!in_order) pick_channels(open, pixels, pixel_count, image.pixels.data());
    return image;
}

template <typename T>
Image<T> read_image(const EncodedImage& image) {
    OpenImage open = open_image(image);
    return read_level<T>(open, {open.spec.width, open.spec.height}, 0);
}

NativeImage read_native_level(OpenImage& open, const ImageLevel& size, int level, TexelDepth depth) {
    switch (depth) {
        case TexelDepth::UInt8:
            return read_level<std::uint8_t>(open, size, level);
        case TexelDepth::UInt16:
            return read_level<std::uint16_t>(open, size, level);
        case TexelDepth::Half:
            return read_level<Float16>(open, size, level);
        case TexelDepth::Float:
            break;
    }
    return read_level<float>(open, size, level);
}

}  // namespace

ImageInfo read_image_info(const EncodedImage& image) {
    return describe(open_image(image));
}

ImageF read_image_float(const EncodedImage& image) {
    return read_image<float>(image);
}

Image8 read_image_8bit(const EncodedImage& image) {
    return read_image<std::uint8_t>(image);
}

std::vector<NativeImage> read_image_levels(const EncodedImage& image) {
    OpenImage open = open_image(image);
    const TexelDepth depth = describe(open).depth;
    const std::vector<ImageLevel> sizes = levels_of(open);
    std::vector<NativeImage> levels;
    levels.reserve(sizes.size());
    for (std::size_t i = 0; i < sizes.size(); ++i)
        levels.push_back(read_native_level(open, sizes[i], static_cast<int>(i), depth));
    return levels;
}

}  // namespace etendue::oiio
