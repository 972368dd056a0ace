#include "image/read_channels.h"

#include "image/encoded_image.h"
#include "image/image_functions.h"

#include <algorithm>

namespace etendue {

const ImageAttribute* ChannelImage::find(std::string_view name) const {
    const auto found = std::ranges::find(attributes, name, &ImageAttribute::name);
    return found == attributes.end() ? nullptr : &*found;
}

ChannelImage read_channels(const ImageSource& source) {
    const EncodedImage image = look_at(source);
    return image_functions().read_channels(image);
}

}  // namespace etendue
