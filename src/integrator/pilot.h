// A few samples that tell which integrator makes an image with the least noise in a given time.
#pragma once

#include "core/parallel.h"
#include "scene/integrator_settings.h"
#include "transport/second_moments.h"
#include "world/world.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>

namespace etendue {

/// Sums estimates of variances, each right in the mean but some of them negative.
struct VarianceSum {
    double sum = 0.0;
    double squares = 0.0;

    void add(double estimate) {
        sum += estimate;
        squares += estimate * estimate;
    }
    /// Returns the mean of all `count` estimates, or what it would be off by if there were no variance, where that is
    /// more: less cannot be told from nothing. Estimates of which none is negative have their mean.
    [[nodiscard]] double mean(double count) const { return std::max(sum, std::sqrt(squares)) / count; }
    /// Returns false if the estimates tell no more than a bound.
    [[nodiscard]] bool is_told() const { return sum > 0.0 && sum >= std::sqrt(squares); }
};

/// Holds what a pilot has found, by integrator.
struct PilotFindings {
    PerIntegrator<double> errors{};  ///< mean squared relative error of an image with one sample per pixel
    PerIntegrator<bool> is_told{};   ///< false: the error is a bound, since samples tell too little
    PerIntegrator<double> costs{};   ///< processor time of a sample, in those of a ray of `path`
    SampleWork work{};               ///< work of a sample, mean

    /// Returns the processor time of a render with a given error, in that of any other here.
    [[nodiscard]] double time_to_error(std::size_t integrator) const { return errors[integrator] * costs[integrator]; }
};

/// Names the integrators of the registry that a pilot compares.
inline constexpr PerIntegrator<std::string_view> kComparedNames{"path", "bdpt", "vcm"};

/// Takes a few samples of `world`, of an image with the proportions of `width` to `height`: a number that depends on
/// these alone. The findings are the same on every machine and for any number of threads.
[[nodiscard]] PilotFindings run_pilot(const World& world, const IntegratorSettings& settings, int width, int height,
                                      const ThreadPool& threads);

}  // namespace etendue
