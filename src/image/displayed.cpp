#include "image/displayed.h"

#include "core/error.h"
#include "core/refused_input.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <variant>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Throws IoError if the display window is more than is allowed, or so empty that a few bytes would take much memory.
void refuse_absurd_display(const ImageInfo& info) {
    constexpr std::int64_t kAlwaysAllowed = std::int64_t{1} << 24;
    constexpr std::int64_t kMostEmpty = 64;
    const PixelRect& display = info.display_window;
    const std::int64_t width = std::int64_t{display.x1} - display.x0;
    const std::int64_t height = std::int64_t{display.y1} - display.y0;
    if (width <= 0 || height <= 0) throw IoError("its display window is empty");
    const std::int64_t held = std::int64_t{info.width} * info.height;
    const std::int64_t most = std::min(kMaxImagePixels, std::max(kAlwaysAllowed, kMostEmpty * held));
    if (width > kMaxImageSide || height > kMaxImageSide || width * height > most)
        throw RefusedInput(
            fmt::format("its display window of {} x {} pixels is far larger than the {} x {} pixels it holds", width,
                        height, info.width, info.height));
}

template <typename T>
Image<T> placed(const Image<T>& data, const ImageInfo& info) {
    const PixelRect& window = info.data_window;
    const PixelRect& display = info.display_window;
    if (data.width != window.width() || data.height != window.height()) throw IoError("it changed while it was read");
    Image<T> whole(display.width(), display.height(), data.channels);
    const PixelRect shown = intersection(window, display);
    for (int y = shown.y0; y < shown.y1; ++y)
        for (int x = shown.x0; x < shown.x1; ++x)
            std::ranges::copy(data.pixel(x - window.x0, y - window.y0),
                              whole.pixel(x - display.x0, y - display.y0).begin());
    return whole;
}

}  // namespace

bool fills_display(const ImageInfo& info) {
    return info.format != "openexr" || info.data_window == info.display_window;
}

ImageInfo read_displayed_info(const ImageSource& source) {
    ImageInfo info = read_image_info(source);
    if (fills_display(info)) return info;
    refuse_absurd_display(info);
    info.width = info.display_window.width();
    info.height = info.display_window.height();
    return info;
}

ImageF read_displayed_float(const ImageSource& source) {
    ImageF data = read_image_float(source);
    const ImageInfo info = read_displayed_info(source);
    return fills_display(info) ? data : placed(data, info);
}

std::vector<NativeImage> read_displayed_levels(const ImageSource& source) {
    std::vector<NativeImage> levels = read_image_levels(source);
    const ImageInfo info = read_displayed_info(source);
    if (fills_display(info)) return levels;
    NativeImage whole = std::visit([&](const auto& data) { return NativeImage(placed(data, info)); }, levels.front());
    return {std::move(whole)};
}

}  // namespace etendue
