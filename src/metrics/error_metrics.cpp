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

double squared_term(double v, double r) {
    return (v - r) * (v - r);
}
double relative(double squared, double r) {
    return squared / (r * r + kMetricEpsilon);
}
double absolute_term(double v, double r) {
    return std::abs(v - r);
}
double symmetric_term(double v, double r) {
    return std::abs(v - r) / (std::abs(v) + std::abs(r) + kMetricEpsilon);
}

double term_of(ErrorMetric metric, double v, double r) {
    switch (metric) {
        case ErrorMetric::Mse:
            return squared_term(v, r);
        case ErrorMetric::Mae:
            return absolute_term(v, r);
        case ErrorMetric::Smape:
            return symmetric_term(v, r);
        case ErrorMetric::RelMse:
        case ErrorMetric::RelMseTrimmed:
            break;
    }
    return relative(squared_term(v, r), r);
}

}  // namespace

std::string_view name_of(ErrorMetric metric) {
    switch (metric) {
        case ErrorMetric::RelMseTrimmed:
            return "relmse-trimmed";
        case ErrorMetric::Mse:
            return "mse";
        case ErrorMetric::Mae:
            return "mae";
        case ErrorMetric::Smape:
            return "smape";
        case ErrorMetric::RelMse:
            break;
    }
    return "relmse";
}

std::string formula_of(ErrorMetric metric) {
    switch (metric) {
        case ErrorMetric::RelMseTrimmed:
            return fmt::format("{} without the largest {:g}% of the terms", formula_of(ErrorMetric::RelMse),
                               100.0 * kTrimmedShare);
        case ErrorMetric::Mse:
            return "mean (v - r)^2";
        case ErrorMetric::Mae:
            return "mean |v - r|";
        case ErrorMetric::Smape:
            return fmt::format("mean |v - r| / (|v| + |r| + {:g})", kMetricEpsilon);
        case ErrorMetric::RelMse:
            break;
    }
    return fmt::format("mean (v - r)^2 / (r^2 + {:g})", kMetricEpsilon);
}

double ErrorMetrics::value(ErrorMetric metric) const {
    switch (metric) {
        case ErrorMetric::RelMseTrimmed:
            return rel_mse_trimmed;
        case ErrorMetric::Mse:
            return mse;
        case ErrorMetric::Mae:
            return mae;
        case ErrorMetric::Smape:
            return smape;
        case ErrorMetric::RelMse:
            break;
    }
    return rel_mse;
}

std::string ErrorMetrics::str() const {
    std::string text;
    for (const ErrorMetric metric : kErrorMetrics)
        text += fmt::format("{:<15} {:.6g}   {}\n", name_of(metric), value(metric), formula_of(metric));
    return text;
}

ErrorMetrics compute_error_metrics(const ImageF& image, const ImageF& reference, const PixelSelection& selection,
                                   std::span<const float> variance) {
    require_same_shape(image, reference, "image and reference");
    if (!variance.empty() && variance.size() != reference.pixels.size())
        throw std::invalid_argument("the variance is not one of each value of the reference");
    ErrorMetrics sums;
    std::vector<double> relative_terms;
    relative_terms.reserve(image.pixels.size());
    const auto channels = static_cast<std::size_t>(image.channels);
    for_each_pixel(image, selection, [&](std::size_t pixel) {
        for (std::size_t i = pixel * channels; i < (pixel + 1) * channels; ++i) {
            const auto v = static_cast<double>(image.pixels[i]);
            const auto r = static_cast<double>(reference.pixels[i]);
            const double squared = squared_term(v, r) - (variance.empty() ? 0.0 : static_cast<double>(variance[i]));
            sums.mse += squared;
            sums.mae += absolute_term(v, r);
            sums.smape += symmetric_term(v, r);
            relative_terms.push_back(relative(squared, r));
            sums.rel_mse += relative_terms.back();
        }
    });
    const auto count = static_cast<double>(relative_terms.size());
    return {.rel_mse = sums.rel_mse / count,
            .rel_mse_trimmed = trimmed_mean(relative_terms, kTrimmedShare),
            .mse = sums.mse / count,
            .mae = sums.mae / count,
            .smape = sums.smape / count};
}

ImageF error_map(ErrorMetric metric, const ImageF& image, const ImageF& reference) {
    require_same_shape(image, reference, "image and reference");
    ImageF map(image.width, image.height, 1);
    const auto channels = static_cast<std::size_t>(image.channels);
    for (std::size_t pixel = 0; pixel < map.pixels.size(); ++pixel) {
        double sum = 0.0;
        for (std::size_t i = pixel * channels; i < (pixel + 1) * channels; ++i)
            sum += term_of(metric, static_cast<double>(image.pixels[i]), static_cast<double>(reference.pixels[i]));
        map.pixels[pixel] = static_cast<float>(sum / static_cast<double>(channels));
    }
    return map;
}

void require_same_shape(const ImageF& a, const ImageF& b, std::string_view what) {
    if (!a.pixels.empty() && a.width == b.width && a.height == b.height && a.channels == b.channels) return;
    throw std::invalid_argument(fmt::format("{} cannot be compared: {}x{} with {} channels, {}x{} with {}", what,
                                            a.width, a.height, a.channels, b.width, b.height, b.channels));
}

}  // namespace etendue
