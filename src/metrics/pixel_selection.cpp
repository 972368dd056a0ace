#include "metrics/pixel_selection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace etendue {

double mean_of(const ImageF& map, const PixelSelection& selection) {
    double sum = 0.0;
    std::size_t count = 0;
    for_each_pixel(map, selection, [&](std::size_t pixel) {
        sum += static_cast<double>(map.pixels[pixel]);
        ++count;
    });
    return count > 0 ? sum / static_cast<double>(count) : std::numeric_limits<double>::quiet_NaN();
}

double quantile_of(const ImageF& map, double share, const PixelSelection& selection) {
    std::vector<float> values;
    values.reserve(map.pixels.size());
    for_each_pixel(map, selection, [&](std::size_t pixel) { values.push_back(map.pixels[pixel]); });
    const bool has_order = std::ranges::none_of(values, [](float value) { return std::isnan(value); });
    if (values.empty() || !has_order) return std::numeric_limits<double>::quiet_NaN();
    const auto last = static_cast<double>(values.size() - 1);
    const auto nth = values.begin() + static_cast<std::ptrdiff_t>(std::ceil(std::clamp(share, 0.0, 1.0) * last));
    std::ranges::nth_element(values, nth);
    return static_cast<double>(*nth);
}

}  // namespace etendue
