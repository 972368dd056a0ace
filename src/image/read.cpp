#include "image/read.h"

#include "image/encoded_image.h"
#include "image/image_functions.h"

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
    return image_functions().read_image_info(image);
}

ImageF read_image_float(const ImageSource& source) {
    const EncodedImage image = look_at(source);
    return image_functions().read_image_float(image);
}

Image8 read_image_8bit(const ImageSource& source) {
    const EncodedImage image = look_at(source);
    return image_functions().read_image_8bit(image);
}

std::vector<NativeImage> read_image_levels(const ImageSource& source) {
    const EncodedImage image = look_at(source);
    return image_functions().read_image_levels(image);
}

std::string image_library_version() {
    return OIIO_VERSION_STRING;
}

}  // namespace etendue
