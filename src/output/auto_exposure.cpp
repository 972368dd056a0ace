#include "output/auto_exposure.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Returns the value that a `share` of `values`, which get another order, lie below.
float percentile(std::vector<float>& values, double share) {
    const auto place = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(place);
    std::ranges::nth_element(values, at);
    return *at;
}

}  // namespace

ChosenExposure choose_exposure(const ImageF& image) {
    std::vector<float> luminances;
    const auto channels = static_cast<std::size_t>(image.channels);
    for (std::size_t i = 0; i + 2 < image.pixels.size(); i += channels) {
        const float y = 0.2126f * image.pixels[i] + 0.7152f * image.pixels[i + 1] + 0.0722f * image.pixels[i + 2];
        if (std::isfinite(y) && y > 0.0f) luminances.push_back(y);
    }
    if (luminances.empty()) return {0.0f, "the image is black"};
    // Lamps that the camera sees may take more than a twentieth of an image, and are no highlights.
    const float bright =
        std::min(percentile(luminances, 0.95), std::max(kHighlight, kLamp * percentile(luminances, 0.75)));
    const float median = percentile(luminances, 0.5);
    const float most = std::log2(kHighlight / bright);
    float stops = std::clamp(0.0f, std::log2(kDimHighlight / bright), most);
    stops = std::max(stops, std::min(std::log2(kDimMedian / median), most + kMostRaise));
    constexpr float kMost = 20.0f;
    stops = std::round(std::clamp(stops, -kMost, kMost) * 100.0f) / 100.0f;
    return {stops, fmt::format("half of it is darker than {:.3g}, and its highlights end at {:.3g}", median, bright)};
}

void choose_missing_exposure(OutputFrame& frame) {
    if (frame.exposure) return;
    ChosenExposure chosen = choose_exposure(frame.pixels);
    frame.exposure = chosen.stops;
    frame.exposure_reason = std::move(chosen.reason);
}

}  // namespace etendue
