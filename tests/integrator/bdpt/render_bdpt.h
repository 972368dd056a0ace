// Images of rooms by bidirectional path tracing as a test wants it.
#pragma once

#include "integrator/agreement_cases.h"
#include "integrator/bdpt/bdpt_integrator.h"
#include "render/render.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

[[nodiscard]] inline const AgreementCase& agreement_case(std::string_view name) {
    for (const AgreementCase& agreement : agreement_cases())
        if (agreement.name == name) return agreement;
    ADD_FAILURE() << "no such room: " << name;
    return agreement_cases().front();
}

/// Of the agreement cases' size; all `threads` (0: of the machine) make the same.
[[nodiscard]] inline std::vector<float> render_bdpt(const World& world, const BdptOptions& options, std::uint32_t spp,
                                                    std::uint32_t seed, int threads = 0) {
    const ThreadPool pool(threads);
    const std::atomic<bool> stop{false};
    RenderOptions render_options;
    render_options.full_width = kAgreementWidth;
    render_options.full_height = kAgreementHeight;
    render_options.window = {0, 0, kAgreementWidth, kAgreementHeight};
    render_options.spp = spp;
    render_options.seed = seed;
    return render(world, BdptIntegrator(options), render_options, pool, stop, {}).film.resolve();
}

/// Of all channels and pixels, alpha left out.
[[nodiscard]] inline double mean_of(const std::vector<float>& rgba) {
    double sum = 0.0;
    for (std::size_t i = 0; i < rgba.size(); ++i)
        if (i % 4 != 3) sum += static_cast<double>(rgba[i]);
    return sum / static_cast<double>(rgba.size() / 4 * 3);
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
