#include "output/display_image.h"

#include "core/error.h"
#include "output/software_name.h"

#include <cstddef>
#include <utility>

namespace etendue {

namespace {

/// Returns the colours without alpha, which for associated alpha is the image over black.
ImageF over_black(const ImageF& image) {
    ImageF rgb(image.width, image.height, 3);
    const auto channels = static_cast<std::size_t>(image.channels);
    for (std::size_t i = 0; i < rgb.pixels.size() / 3; ++i) {
        for (std::size_t c = 0; c < 3; ++c) rgb.pixels[3 * i + c] = image.pixels[channels * i + c];
    }
    return rgb;
}

}  // namespace

DisplayView with_defaults(DisplayView view, const ColorConfig& config) {
    if (view.display.empty()) view.display = config.default_display();
    if (view.view.empty()) view.view = config.default_view(view.display);
    return view;
}

ImageF display_image(const ImageF& image, const DisplayView& view, const ColorConfig& config) {
    if (image.channels < 3) throw IoError("cannot show an image that is not RGB or RGBA");
    const DisplayView full = with_defaults(view, config);
    const ColorTransform transform =
        config.display_transform(full.working_space, full.display, full.view, full.exposure, full.look);
    ImageF shown = over_black(image);
    transform.apply(shown.pixels, 3);
    return shown;
}

std::vector<ImageAttribute> display_attributes(const DisplayView& view) {
    std::vector<ImageAttribute> attributes{{"Software", std::string(software_name())},
                                           {"etendue:display", view.display},
                                           {"etendue:view", view.view},
                                           {"etendue:exposure", std::to_string(view.exposure)}};
    if (!view.look.empty()) attributes.push_back({"etendue:look", view.look});
    // PNG has a chunk for sRGB; programs take an image without one for sRGB too, so others are better left unsaid.
    if (view.display.starts_with("sRGB")) attributes.push_back({"oiio:ColorSpace", std::string("sRGB")});
    return attributes;
}

}  // namespace etendue
