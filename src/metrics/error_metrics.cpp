#include "metrics/error_metrics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Mean of `terms` without the largest `share` of them; reorders them.
double trimmed_mean(std::vector<double>& terms, double share) {
    // Selecting the largest needs an order, which NaN has not.
    for (const double term : terms)
        if (std::isnan(term)) return std::numeric_limits<double>::quiet_NaN();
    const auto dropped = static_cast<std::ptrdiff_t>(share * static_cast<double>(terms.size()));
    const auto first_kept = terms.begin() + dropped;
    if (dropped > 0) std::nth_element(terms.begin(), first_kept, terms.end(), std::greater<>());
    return std::accumulate(first_kept, terms.end(), 0.0) / static_cast<double>(terms.end() - first_kept);
}

}  // namespace

std::string ErrorMetrics::str() const {
    return fmt::format(
        "relMSE          {:.6g}   mean (v - r)^2 / (r^2 + {:g})\n"
        "relMSE trimmed  {:.6g}   the same without the largest {:g}% of the terms\n"
        "MSE             {:.6g}   mean (v - r)^2\n"
        "MAE             {:.6g}   mean |v - r|\n"
        "SMAPE           {:.6g}   mean |v - r| / (|v| + |r| + {:g})\n",
        rel_mse, kMetricEpsilon, rel_mse_trimmed, 100.0 * kTrimmedShare, mse, mae, smape, kMetricEpsilon);
}

ErrorMetrics compute_error_metrics(const ImageF& image, const ImageF& reference) {
    require_same_shape(image, reference, "image and reference");
    ErrorMetrics sums;
    std::vector<double> relative_terms;
    relative_terms.reserve(image.pixels.size());
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const auto v = static_cast<double>(image.pixels[i]);
        const auto r = static_cast<double>(reference.pixels[i]);
        const double difference = std::abs(v - r);
        const double squared = difference * difference;
        sums.mse += squared;
        sums.mae += difference;
        sums.smape += difference / (std::abs(v) + std::abs(r) + kMetricEpsilon);
        relative_terms.push_back(squared / (r * r + kMetricEpsilon));
        sums.rel_mse += relative_terms.back();
    }
    const auto count = static_cast<double>(image.pixels.size());
    return {.rel_mse = sums.rel_mse / count,
            .rel_mse_trimmed = trimmed_mean(relative_terms, kTrimmedShare),
            .mse = sums.mse / count,
            .mae = sums.mae / count,
            .smape = sums.smape / count};
}

void require_same_shape(const ImageF& a, const ImageF& b, std::string_view what) {
    if (!a.pixels.empty() && a.width == b.width && a.height == b.height && a.channels == b.channels) return;
    throw std::invalid_argument(fmt::format("{} cannot be compared: {}x{} with {} channels, {}x{} with {}", what,
                                            a.width, a.height, a.channels, b.width, b.height, b.channels));
}

}  // namespace etendue
