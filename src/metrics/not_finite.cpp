#include "metrics/not_finite.h"

#include "metrics/error_metrics.h"

#include <algorithm>
#include <cmath>

namespace etendue {

namespace {

bool is_finite(std::span<const float> channels) {
    return std::ranges::all_of(channels, [](float value) { return std::isfinite(value); });
}

/// The channels of the pixel at place `i`.
std::span<const float> channels_of(const ImageF& image, std::size_t i) {
    const auto channels = static_cast<std::size_t>(image.channels);
    return {image.pixels.data() + i * channels, channels};
}

}  // namespace

NotFinite find_not_finite(const ImageF& image) {
    NotFinite found;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const std::span<const float> channels = image.pixel(x, y);
            if (is_finite(channels)) continue;
            const bool has_nan = std::ranges::any_of(channels, [](float value) { return std::isnan(value); });
            if (found.count() == 0) found.bounds = {x, y, x + 1, y + 1};
            found.bounds = {std::min(found.bounds.x0, x), std::min(found.bounds.y0, y),
                            std::max(found.bounds.x1, x + 1), std::max(found.bounds.y1, y + 1)};
            ++(has_nan ? found.nan : found.infinite);
            if (found.first.size() < NotFinite::kMostFirst) found.first.emplace_back(x, y);
        }
    }
    return found;
}

std::vector<std::uint8_t> mark_not_finite(const ImageF& image, const ImageF& reference) {
    require_same_shape(image, reference, "image and reference");
    std::vector<std::uint8_t> marks(image.pixels.size() / static_cast<std::size_t>(image.channels));
    for (std::size_t i = 0; i < marks.size(); ++i)
        marks[i] = is_finite(channels_of(image, i)) && is_finite(channels_of(reference, i)) ? 0 : 1;
    return marks;
}

void blank(ImageF& image, std::span<const std::uint8_t> marks) {
    const auto channels = static_cast<std::ptrdiff_t>(image.channels);
    for (std::size_t i = 0; i < marks.size(); ++i)
        if (marks[i] != 0)
            std::fill_n(image.pixels.begin() + static_cast<std::ptrdiff_t>(i) * channels, channels, 0.0f);
}

}  // namespace etendue
