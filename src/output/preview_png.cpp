#include "output/preview_png.h"

#include "core/error.h"
#include "core/pixel_rect.h"
#include "image/write.h"
#include "output/display_image.h"

#include <algorithm>
#include <cstddef>
#include <optional>

namespace etendue {

namespace {

/// Returns the pixels of the frame that lie within the image; nothing if all of them do, or none.
std::optional<ImageF> without_overscan(const OutputFrame& frame) {
    const ImageF& all = frame.pixels;
    const PixelRect data = moved_to({0, 0, all.width, all.height}, frame.crop_x, frame.crop_y);
    const PixelRect shown = intersection(data, {0, 0, frame.full_width, frame.full_height});
    if (frame.full_width == 0 || shown == data || shown.empty()) return {};
    ImageF part(shown.width(), shown.height(), all.channels);
    for (int y = shown.y0; y < shown.y1; ++y)
        for (int x = shown.x0; x < shown.x1; ++x)
            std::ranges::copy(all.pixel(x - data.x0, y - data.y0), part.pixel(x - shown.x0, y - shown.y0).begin());
    return part;
}

double clipped_share_of(const ImageF& shown) {
    constexpr float kBrightest = 254.5f / 255.0f;  // what is rounded to it
    std::size_t clipped = 0;
    for (std::size_t i = 0; i + 2 < shown.pixels.size(); i += 3)
        if (std::max({shown.pixels[i], shown.pixels[i + 1], shown.pixels[i + 2]}) >= kBrightest) ++clipped;
    const std::size_t count = shown.pixels.size() / 3;
    return count > 0 ? static_cast<double>(clipped) / static_cast<double>(count) : 0.0;
}

}  // namespace

double write_preview_png(const std::filesystem::path& path, const OutputFrame& frame, const ColorConfig& config) {
    if (frame.pixels.channels < 3) throw IoError("cannot write " + path.string() + ": the image is not RGB or RGBA");
    const DisplayView view = with_defaults(
        {frame.working_space, frame.display, frame.view, frame.look, frame.exposure.value_or(0.0f)}, config);
    ImageWriteOptions options;
    options.depth = PixelDepth::UInt8;
    options.attributes = display_attributes(view);
    options.attributes.push_back({"etendue:scene", frame.scene});
    const std::optional<ImageF> part = without_overscan(frame);
    const ImageF shown = display_image(part ? *part : frame.pixels, view, config);
    write_image(path, shown, options);
    return clipped_share_of(shown);
}

}  // namespace etendue
