#include "output/output_space.h"

#include "core/error.h"

namespace etendue {

void convert_space(ImageF& image, const std::string& from, const std::string& to, const ColorConfig& config) {
    if (image.channels != 3 && image.channels != 4) throw IoError("cannot convert an image that is not RGB or RGBA");
    config.transform(from, to).apply(image.pixels, image.channels);
}

bool is_to_be_converted(const OutputFrame& frame) {
    return !frame.output_space.empty() && frame.output_space != frame.working_space;
}

void to_output_space(OutputFrame& frame, const ColorConfig& config) {
    if (!is_to_be_converted(frame)) return;
    convert_space(frame.pixels, frame.working_space, frame.output_space, config);
    for (OutputLayer& layer : frame.layers)
        if (layer.is_color) convert_space(layer.pixels, frame.working_space, frame.output_space, config);
    if (!frame.deep.depths.empty()) convert_space(frame.deep.colors, frame.working_space, frame.output_space, config);
    frame.working_space = frame.output_space;
}

}  // namespace etendue
