// Small images for the tests of the denoiser.
#pragma once

#include "denoise/halves.h"
#include "denoise/planes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

namespace etendue::test {

/// Planes of values that do not depend on the plane.
template <typename Function>
Planes same_planes(int width, int height, int count, const Function& value) {
    return make_planes(width, height, count, [&](int, int x, int y) { return value(x, y); });
}

/// `truth` plus Gaussian noise of the standard deviation `sigma` in a mean of all samples, of which half a has the
/// share `share`; its variance is estimated from the halves.
inline Halves noisy_halves(const Planes& truth, float sigma, std::uint32_t seed, float share = 0.5f) {
    std::mt19937 generator(seed);
    std::normal_distribution<float> normal;
    const auto with_noise = [&](float part) {
        return make_planes(truth.width(), truth.height(), truth.count(), [&](int plane, int x, int y) {
            return truth.row(plane, y)[x] + sigma / std::sqrt(part) * normal(generator);
        });
    };
    const Planes a = with_noise(share);
    const Planes b = with_noise(1.0f - share);
    return make_halves(mean_of_all(a, b, share), a, share);
}

inline double mean_squared_difference(const Planes& a, const Planes& b) {
    double sum = 0.0;
    for (int plane = 0; plane < a.count(); ++plane)
        for (int y = 0; y < a.height(); ++y)
            for (int x = 0; x < a.width(); ++x) {
                const double difference = double(a.row(plane, y)[x]) - double(b.row(plane, y)[x]);
                sum += difference * difference;
            }
    return sum / (double(a.width()) * a.height() * a.count());
}

inline double largest_difference(const Planes& a, const Planes& b) {
    double largest = 0.0;
    for (int plane = 0; plane < a.count(); ++plane)
        for (int y = 0; y < a.height(); ++y)
            for (int x = 0; x < a.width(); ++x)
                largest = std::max(largest, std::abs(double(a.row(plane, y)[x]) - double(b.row(plane, y)[x])));
    return largest;
}

}  // namespace etendue::test
