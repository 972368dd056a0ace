#include "film/pixel_filter.h"

#include <cmath>
#include <cstddef>
#include <vector>

namespace etendue {

namespace {

float default_radius(FilterShape shape) {
    switch (shape) {
        case FilterShape::BlackmanHarris: return 1.5f;
        case FilterShape::Box: return 0.5f;
        case FilterShape::Gaussian: return 1.5f;
        case FilterShape::Mitchell: return 2.0f;
    }
    return 0.5f;
}

/// Mitchell and Netravali, "Reconstruction Filters in Computer Graphics" (SIGGRAPH 1988), equation 8; |x| in [0, 2].
float mitchell(float x) {
    constexpr float kB = 1.0f / 3.0f;
    constexpr float kC = 1.0f / 3.0f;
    const float x2 = x * x;
    const float x3 = x2 * x;
    if (x < 1.0f)
        return ((12 - 9 * kB - 6 * kC) * x3 + (-18 + 12 * kB + 6 * kC) * x2 + (6 - 2 * kB)) / 6.0f;
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
        case FilterShape::Box: return 1.0f;
        case FilterShape::Gaussian: return std::exp(-4.5f * t * t) - std::exp(-4.5f);
        case FilterShape::Mitchell: return mitchell(2.0f * std::abs(t));
    }
    return 0.0f;
}

}  // namespace

PixelFilter::PixelFilter(FilterShape shape, float radius)
    : shape_(shape), radius_(radius > 0.0f ? radius : default_radius(shape)) {
    constexpr std::size_t kCells = 1024;
    std::vector<float> magnitudes(kCells);
    double integral = 0.0;
    for (std::size_t i = 0; i < kCells; ++i) {
        const float t = 2.0f * (static_cast<float>(i) + 0.5f) / kCells - 1.0f;
        const float value = shape_value(shape_, t);
        magnitudes[i] = std::abs(value);
        integral += static_cast<double>(value);
    }
    magnitude_ = Distribution1D(magnitudes);
    normalization_ = static_cast<float>(kCells / (integral * 2.0 * static_cast<double>(radius_)));
}

float PixelFilter::evaluate(float x) const {
    if (std::abs(x) > radius_) return 0.0f;
    return shape_value(shape_, x / radius_) * normalization_;
}

PixelFilter::Sample1D PixelFilter::sample_1d(float u) const {
    const Distribution1D::Sample sample = magnitude_.sample(u);
    const float offset = (2.0f * sample.x - 1.0f) * radius_;
    const float pdf = sample.pdf / (2.0f * radius_);
    return {offset, evaluate(offset) / pdf};
}

PixelFilter::Sample PixelFilter::sample(Vec2f u) const {
    const Sample1D x = sample_1d(u.x);
    const Sample1D y = sample_1d(u.y);
    return {{x.offset, y.offset}, x.weight * y.weight};
}

}  // namespace etendue
