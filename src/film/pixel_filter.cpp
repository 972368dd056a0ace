#include "film/pixel_filter.h"

#include <cmath>
#include <cstddef>
#include <vector>

namespace etendue {

namespace {

float default_radius(FilterShape shape) {
    switch (shape) {
        case FilterShape::BlackmanHarris:
            return 1.5f;
        case FilterShape::Box:
            return 0.5f;
        case FilterShape::Gaussian:
            return 1.5f;
        case FilterShape::Mitchell:
            return 2.0f;
    }
    return 0.5f;
}

/// Mitchell and Netravali, "Reconstruction Filters in Computer Graphics" (SIGGRAPH 1988), equation 8; |x| in [0, 2].
float mitchell(float x) {
    constexpr float kB = 1.0f / 3.0f;
    constexpr float kC = 1.0f / 3.0f;
    const float x2 = x * x;
    const float x3 = x2 * x;
    if (x < 1.0f) return ((12 - 9 * kB - 6 * kC) * x3 + (-18 + 12 * kB + 6 * kC) * x2 + (6 - 2 * kB)) / 6.0f;
    return ((-kB - 6 * kC) * x3 + (6 * kB + 30 * kC) * x2 + (-12 * kB - 48 * kC) * x + (8 * kB + 24 * kC)) / 6.0f;
}

/// Unnormalised, `t` = x / radius in [-1, 1].
float shape_value(FilterShape shape, float t) {
    switch (shape) {
        case FilterShape::BlackmanHarris: {
            // Harris, "On the Use of Windows for Harmonic Analysis" (1978), the 4-term window.
            const float phase = kPi * (t + 1.0f);
            return 0.35875f - 0.48829f * std::cos(phase) + 0.14128f * std::cos(2.0f * phase) -
                   0.01168f * std::cos(3.0f * phase);
        }
        case FilterShape::Box:
            return 1.0f;
        case FilterShape::Gaussian:
            return std::exp(-4.5f * t * t) - std::exp(-4.5f);
        case FilterShape::Mitchell:
            return mitchell(2.0f * std::abs(t));
    }
    return 0.0f;
}

}  // namespace

PixelFilter::PixelFilter(FilterShape shape, float radius)
    : shape_(shape), radius_(radius > 0.0f ? radius : default_radius(shape)), edges_(kCells + 1), values_(kValues + 1) {
    // The distribution function on a grid much finer than the cells, then its inverse at equal steps.
    constexpr std::size_t kSteps = 64 * kCells;
    std::vector<double> cdf(kSteps + 1, 0.0);
    double integral = 0.0;
    positive_radius_ = radius_;
    for (std::size_t i = 0; i < kSteps; ++i) {
        const float t = 2.0f * (static_cast<float>(i) + 0.5f) / kSteps - 1.0f;
        const auto value = static_cast<double>(shape_value(shape, t));
        cdf[i + 1] = cdf[i] + std::abs(value);
        integral += value;
        if (value < 0.0) positive_radius_ = std::min(positive_radius_, std::abs(t) * radius_);
    }
    std::size_t step = 0;
    for (std::size_t cell = 0; cell <= kCells; ++cell) {
        const double mass = cdf.back() * static_cast<double>(cell) / kCells;
        while (step + 1 < kSteps && cdf[step + 1] < mass) ++step;
        const double inside = cdf[step + 1] - cdf[step];
        const double fraction = inside > 0.0 ? (mass - cdf[step]) / inside : 0.0;
        const double t = 2.0 * (static_cast<double>(step) + fraction) / kSteps - 1.0;
        edges_[cell] = static_cast<float>(t) * radius_;
    }
    weight_ = static_cast<float>(cdf.back() / integral);
    const auto normalization = static_cast<float>(kSteps / (integral * 2.0 * static_cast<double>(radius_)));
    for (std::size_t i = 0; i <= kValues; ++i)
        values_[i] = shape_value(shape, static_cast<float>(i) / static_cast<float>(kValues)) * normalization;
    steps_per_pixel_ = static_cast<float>(kValues) / radius_;
}

}  // namespace etendue
