#include "core/error.h"
#include "oiio/functions.h"
#include "oiio/library_setup.h"

#include <memory>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

namespace etendue::oiio {

std::vector<unsigned char> encode_jpeg(const ImageF& image, int quality) {
    configure_image_library();
    const int channels = image.channels < 3 ? 1 : 3;
    OIIO::ImageSpec spec(image.width, image.height, channels, OIIO::TypeDesc::UINT8);
    spec.attribute("Compression", fmt::format("jpeg:{}", quality));
    std::vector<unsigned char> encoded;
    OIIO::Filesystem::IOVecOutput memory(encoded);
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create("jpeg");
    if (!output) throw IoError(fmt::format("cannot encode a JPEG: {}", OIIO::geterror()));
    output->threads(1);
    const auto pixel_stride = static_cast<OIIO::stride_t>(sizeof(float)) * static_cast<OIIO::stride_t>(image.channels);
    if (!output->set_ioproxy(&memory) || !output->open("memory.jpg", spec) ||
        !output->write_image(OIIO::TypeDesc::FLOAT, image.pixels.data(), pixel_stride) || !output->close())
        throw IoError(fmt::format("cannot encode a JPEG: {}", output->geterror()));
    return encoded;
}

}  // namespace etendue::oiio
