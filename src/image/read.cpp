#include "image/read.h"

#include "core/error.h"
#include "image/encoded_image.h"
#include "image/image_functions.h"

#include <utility>

#include <OpenImageIO/oiioversion.h>

namespace etendue {

std::size_t bytes_of(TexelDepth depth) {
    switch (depth) {
        case TexelDepth::UInt8:
            return 1;
        case TexelDepth::UInt16:
        case TexelDepth::Half:
            return 2;
        case TexelDepth::Float:
            break;
    }
    return 4;
}

// What is no image is refused before the functions are asked for, which loads them.

ImageInfo read_image_info(const ImageSource& source) {
    const EncodedImage image = look_at(source);
    ImageInfo info = image_functions().read_image_info(image);
    if (image.radiance) {
        info.width = image.radiance->width;
        info.height = image.radiance->height;
        info.data_window = info.display_window = {0, 0, info.width, info.height};
    }
    return info;
}

ImageF read_image_float(const ImageSource& source) {
    const EncodedImage image = look_at(source);
    ImageF pixels = image_functions().read_image_float(image);
    return image.radiance ? developed(std::move(pixels), *image.radiance) : pixels;
}

Image8 read_image_8bit(const ImageSource& source) {
    const EncodedImage image = look_at(source);
    if (image.radiance) throw IoError("a Radiance picture with such a header is not read in 8 bits");
    return image_functions().read_image_8bit(image);
}

std::vector<NativeImage> read_image_levels(const ImageSource& source) {
    const EncodedImage image = look_at(source);
    if (image.radiance) return {read_image_float(source)};
    return image_functions().read_image_levels(image);
}

std::string image_library_version() {
    return OIIO_VERSION_STRING;
}

}  // namespace etendue
