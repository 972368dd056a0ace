// Images of rooms by bidirectional path tracing as a test wants it.
#pragma once

#include "integrator/agreement_cases.h"
#include "integrator/bdpt/bdpt_integrator.h"
#include "render/whole_image.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

/// Of the agreement cases' size; all `threads` (0: of the machine) make the same.
[[nodiscard]] inline std::vector<float> render_bdpt(const World& world, IntegratorSettings settings, std::uint32_t spp,
                                                    std::uint32_t seed, int threads = 0) {
    settings.merging.at = MergeAt::Nothing;
    const ThreadPool pool(threads);
    const std::atomic<bool> stop{false};
    return render(world, BdptIntegrator(settings), whole_image(kAgreementWidth, kAgreementHeight, spp, seed), pool,
                  stop, {})
        .film.resolve();
}

/// Of all channels and pixels, alpha left out.
[[nodiscard]] inline double mean_of(const std::vector<float>& rgba) {
    double sum = 0.0;
    for (std::size_t i = 0; i < rgba.size(); ++i)
        if (i % 4 != 3) sum += static_cast<double>(rgba[i]);
    const std::size_t count = rgba.size() / 4 * 3;
    return sum / static_cast<double>(count);
}

/// A mean and its standard error, from independent values.
struct MeanEstimate {
    double mean = 0.0;
    double error = 0.0;

    explicit MeanEstimate(const std::vector<double>& values) {
        const auto count = static_cast<double>(values.size());
        double squares = 0.0;
        for (const double value : values) {
            mean += value / count;
            squares += value * value / count;
        }
        error = std::sqrt(std::max(0.0, squares - mean * mean) / (count - 1.0));
    }
};

}  // namespace etendue::test
