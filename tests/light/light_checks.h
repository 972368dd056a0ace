// Estimates that the tests of several lights share.
#pragma once

#include "light/light.h"
#include "support/random.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace etendue::test {

/// `count` estimates of the irradiance (mean of the channels, W/m²) that `light` brings to `point` on a surface with
/// unit `normal`, without occlusion.
[[nodiscard]] inline std::vector<double> irradiance_samples(const Light& light, const Vec3f& point, const Vec3f& normal,
                                                            std::size_t count, std::uint32_t seed) {
    Random random(seed);
    std::vector<double> samples(count);
    for (double& value : samples) {
        const LightSample s = sample_light(light, point, random.next_2d(), random.next_2d());
        const auto received = static_cast<double>(average(s.radiance) * std::max(0.0f, dot(s.wi, normal)));
        if (is_black(s.radiance))
            value = 0.0;
        else
            value = s.is_delta ? received : received / static_cast<double>(s.pdf_solid_angle);
    }
    return samples;
}

/// Integral of f over the sphere of directions by a midpoint rule of 2 n² cells of equal solid angle.
template <typename F>
[[nodiscard]] double integrate_directions(int n, const F& f) {
    double sum = 0.0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < 2 * n; ++j) {
            const float z = 1.0f - (2.0f * static_cast<float>(i) + 1.0f) / static_cast<float>(n);
            const float phi = kPi * (static_cast<float>(j) + 0.5f) / static_cast<float>(n);
            const float r = std::sqrt(1.0f - z * z);
            sum += static_cast<double>(f(Vec3f(r * std::cos(phi), r * std::sin(phi), z)));
        }
    return sum * 2.0 * static_cast<double>(kPi) / (static_cast<double>(n) * static_cast<double>(n));
}

}  // namespace etendue::test
