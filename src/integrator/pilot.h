// A few samples that tell which integrator makes an image with the least noise in a given time.
#pragma once

#include "core/parallel.h"
#include "scene/integrator_settings.h"
#include "transport/second_moments.h"
#include "world/world.h"

#include <string_view>

namespace etendue {

/// Holds what a pilot has found, by integrator.
struct PilotFindings {
    PerIntegrator<double> errors{};  ///< mean squared relative error of an image with one sample per pixel
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
