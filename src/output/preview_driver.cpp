#include "output/preview_driver.h"

#include "core/error.h"
#include "image/write.h"
#include "output/display_image.h"

#include <utility>

namespace etendue {

PreviewDriver::PreviewDriver(std::filesystem::path path, ColorConfig config)
    : path_(std::move(path)), config_(std::move(config)) {}

void PreviewDriver::write(const OutputFrame& frame) {
    if (frame.pixels.channels < 3) throw IoError("cannot write " + path_.string() + ": the image is not RGB or RGBA");
    const DisplayView view =
        with_defaults({frame.working_space, frame.display, frame.view, frame.look, frame.exposure}, config_);
    ImageWriteOptions options;
    options.depth = PixelDepth::UInt8;
    options.attributes = display_attributes(view);
    options.attributes.push_back({"etendue:scene", frame.scene});
    write_image(path_, display_image(frame.pixels, view, config_), options);
}

}  // namespace etendue
