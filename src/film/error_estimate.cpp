#include "film/error_estimate.h"

#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

namespace etendue {

double estimate_relative_error(const Film& whole, const Film& part, double share) {
    constexpr double kEpsilon = 1e-2;
    assert(whole.window() == part.window() && share > 0.0 && share < 1.0);
    const std::vector<float> all = whole.resolve();
    const std::vector<float> some = part.resolve();
    // b = (v - s a) / (1 - s), hence a - b = (a - v) / (1 - s).
    const double scale = share / (1.0 - share);
    double sum = 0.0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        constexpr std::size_t kChannels = 4;
        if (i % kChannels == 3) continue;  // alpha
        const auto value = static_cast<double>(all[i]);
        const double off = static_cast<double>(some[i]) - value;
        sum += off * off * scale / (value * value + kEpsilon);
    }
    return std::sqrt(sum / (3.0 * static_cast<double>(whole.window().area())));
}

}  // namespace etendue
