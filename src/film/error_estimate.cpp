#include "film/error_estimate.h"

#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace etendue {

namespace {

using Means = std::array<double, 3>;

/// s / (1 - s), which takes (a - v)² to (a - b)² s (1 - s), as b = (v - s a) / (1 - s).
double odds(std::uint64_t part, std::uint64_t whole) {
    if (part == 0 || part >= whole) return 0.0;
    return static_cast<double>(part) / static_cast<double>(whole - part);
}

/// Mean over the channels of (part - whole)² / (value² + 0.01).
double relative_square(const Means& whole, const Means& part, const Means& value) {
    constexpr double kEpsilon = 1e-2;
    double sum = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
        const double off = part[c] - whole[c];
        sum += off * off / (value[c] * value[c] + kEpsilon);
    }
    return sum / 3.0;
}

}  // namespace

double ErrorEstimate::relative_error() const {
    return std::sqrt(eye_mean + light);
}

ErrorEstimate estimate_errors(const Film& whole, const Film& part) {
    assert(whole.window() == part.window());
    const PixelRect& window = whole.window();
    const double light_odds = odds(part.light_paths(), whole.light_paths());
    ErrorEstimate errors;
    errors.eye.reserve(window.area());
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x) {
            const Means eye = whole.eye_mean(x, y);
            const Means light = whole.light_mean(x, y);
            const Means value{eye[0] + light[0], eye[1] + light[1], eye[2] + light[2]};
            const double of_eye = odds(part.sample_count(x, y), whole.sample_count(x, y)) *
                                  relative_square(eye, part.eye_mean(x, y), value);
            errors.eye.push_back(static_cast<float>(of_eye));
            errors.eye_mean += of_eye;
            errors.light += light_odds * relative_square(light, part.light_mean(x, y), value);
        }
    const auto area = static_cast<double>(window.area());
    errors.eye_mean /= area;
    errors.light /= area;
    return errors;
}

}  // namespace etendue
