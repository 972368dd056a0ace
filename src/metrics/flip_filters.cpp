#include "metrics/flip_filters.h"

#include <cmath>
#include <numbers>
#include <numeric>

namespace etendue {

namespace {

constexpr double kPi2 = std::numbers::pi * std::numbers::pi;
/// w, degrees.
constexpr double kEdgeWidth = 0.082;

/// One term a sqrt(pi / b) exp(-pi^2 d^2 / b) of a filter.
struct GaussianTerm {
    double a;
    double b;  ///< square degrees

    [[nodiscard]] double amplitude() const { return a * std::sqrt(std::numbers::pi / b); }
};

constexpr GaussianTerm kLuminance{1.0, 0.0047};
constexpr GaussianTerm kRedGreen{1.0, 0.0053};
constexpr GaussianTerm kBlueWide{34.1, 0.04};
constexpr GaussianTerm kBlueNarrow{13.5, 0.025};

std::vector<double> exponentials(double b, int radius, double pixels_per_degree) {
    std::vector<double> values;
    for (int i = -radius; i <= radius; ++i) {
        const double degrees = i / pixels_per_degree;
        values.push_back(std::exp(-kPi2 * degrees * degrees / b));
    }
    return values;
}

double sum_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

FilterWeights scaled(const std::vector<double>& values, double scale) {
    FilterWeights weights;
    weights.reserve(values.size());
    for (const double value : values) weights.push_back(static_cast<float>(scale * value));
    return weights;
}

FilterWeights normalized(const std::vector<double>& values) {
    return scaled(values, 1.0 / sum_of(values));
}

/// Positive and negative weights each by their own sum.
FilterWeights normalized_by_sign(const std::vector<double>& values) {
    double positive = 0.0;
    double negative = 0.0;
    for (const double value : values) (value > 0.0 ? positive : negative) += std::abs(value);
    FilterWeights weights;
    weights.reserve(values.size());
    for (const double value : values)
        weights.push_back(static_cast<float>(value / (value > 0.0 ? positive : negative)));
    return weights;
}

}  // namespace

ContrastFilters contrast_filters(double pixels_per_degree) {
    // The widest term, of standard deviation sqrt(b / (2 pi^2)).
    const double deviation = std::sqrt(kBlueWide.b / (2.0 * kPi2));
    ContrastFilters filters;
    filters.radius = static_cast<int>(std::ceil(3.0 * deviation * pixels_per_degree));
    filters.luminance = normalized(exponentials(kLuminance.b, filters.radius, pixels_per_degree));
    filters.red_green = normalized(exponentials(kRedGreen.b, filters.radius, pixels_per_degree));

    const std::vector<double> narrow = exponentials(kBlueNarrow.b, filters.radius, pixels_per_degree);
    const std::vector<double> wide = exponentials(kBlueWide.b, filters.radius, pixels_per_degree);
    const double narrow_sum = sum_of(narrow);
    const double wide_sum = sum_of(wide);
    const double total =
        kBlueNarrow.amplitude() * narrow_sum * narrow_sum + kBlueWide.amplitude() * wide_sum * wide_sum;
    filters.blue_narrow = scaled(narrow, std::sqrt(kBlueNarrow.amplitude() / total));
    filters.blue_wide = scaled(wide, std::sqrt(kBlueWide.amplitude() / total));
    return filters;
}

FeatureFilters feature_filters(double pixels_per_degree) {
    const double deviation = 0.5 * kEdgeWidth * pixels_per_degree;
    FeatureFilters filters;
    filters.radius = static_cast<int>(std::ceil(3.0 * deviation));
    std::vector<double> gaussian;
    std::vector<double> first;
    std::vector<double> second;
    for (int i = -filters.radius; i <= filters.radius; ++i) {
        const double x = i / deviation;
        gaussian.push_back(std::exp(-0.5 * x * x));
        first.push_back(-x * gaussian.back());
        second.push_back((x * x - 1.0) * gaussian.back());
    }
    filters.gaussian = normalized(gaussian);
    filters.edge = normalized_by_sign(first);
    filters.point = normalized_by_sign(second);
    return filters;
}

}  // namespace etendue
