#include "output/preview_driver.h"

#include "core/error.h"
#include "image/write.h"
#include "output/software_name.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

namespace etendue {

namespace {

// The colours without alpha, which for associated alpha is the image over black.
ImageF over_black(const ImageF& image) {
    ImageF rgb(image.width, image.height, 3);
    const auto channels = static_cast<std::size_t>(image.channels);
    for (std::size_t i = 0; i < rgb.pixels.size() / 3; ++i) {
        for (std::size_t c = 0; c < 3; ++c) rgb.pixels[3 * i + c] = image.pixels[channels * i + c];
    }
    return rgb;
}

}  // namespace

PreviewDriver::PreviewDriver(std::filesystem::path path, ColorConfig config)
    : path_(std::move(path)), config_(std::move(config)) {}

void PreviewDriver::write(const OutputFrame& frame) {
    if (frame.pixels.channels < 3) throw IoError("cannot write " + path_.string() + ": the image is not RGB or RGBA");
    const std::string display = frame.display.empty() ? config_.default_display() : frame.display;
    const std::string view = frame.view.empty() ? config_.default_view(display) : frame.view;
    const ColorTransform transform = config_.display_transform(frame.working_space, display, view, frame.exposure);

    ImageF image = over_black(frame.pixels);
    transform.apply(image.pixels, 3);
    ImageWriteOptions options;
    options.depth = PixelDepth::UInt8;
    options.attributes = {{"Software", std::string(software_name())},
                          {"etendue:scene", frame.scene},
                          {"etendue:display", display},
                          {"etendue:view", view},
                          {"etendue:exposure", std::to_string(frame.exposure)}};
    // PNG has a chunk for sRGB; programs take an image without one for sRGB too, so others are better left unsaid.
    if (display.starts_with("sRGB")) options.attributes.push_back({"oiio:ColorSpace", std::string("sRGB")});
    write_image(path_, image, options);
}

}  // namespace etendue
