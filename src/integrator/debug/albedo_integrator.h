#pragma once

#include "integrator/scalar_integrator.h"

namespace etendue {

/// Shows the share of light that surfaces scatter, seen from the eye.
struct AlbedoIntegrator final : ScalarIntegrator {
    explicit AlbedoIntegrator(const IntegratorSettings& settings) : ScalarIntegrator(settings, Shows::NoLight) {}
    [[nodiscard]] EyeLight li(const World& world, const EyeSample& sample, const Hit& hit) const override;
};

}  // namespace etendue
