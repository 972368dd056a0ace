#include "image/jpeg.h"

#include "image/image_functions.h"

namespace etendue {

std::vector<unsigned char> encode_jpeg(const ImageF& image, int quality) {
    return image_functions().encode_jpeg(image, quality);
}

}  // namespace etendue
