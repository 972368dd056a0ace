#include "output/output_space.h"

#include "core/error.h"

namespace etendue {

void convert_space(ImageF& image, const std::string& from, const std::string& to, const ColorConfig& config) {
    if (image.channels != 3 && image.channels != 4) throw IoError("cannot convert an image that is not RGB or RGBA");
    config.transform(from, to).apply(image.pixels, image.channels);
}

ImageF in_output_space(const OutputFrame& frame, const ColorConfig& config) {
    ImageF pixels = frame.pixels;
    const std::string& to = frame.output_space.empty() ? frame.working_space : frame.output_space;
    if (to != frame.working_space) convert_space(pixels, frame.working_space, to, config);
    return pixels;
}

}  // namespace etendue
