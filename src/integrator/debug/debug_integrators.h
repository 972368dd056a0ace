// Integrators that show no light, for finding out what is wrong.
#pragma once

#include "integrator/scalar_integrator.h"

namespace etendue {

/// Shows shading normals in world space, each component mapped from [-1, 1] to [0, 1].
struct NormalsIntegrator final : ScalarIntegrator {
    explicit NormalsIntegrator(const IntegratorSettings& settings) : ScalarIntegrator(settings, Shows::NoLight) {}
    [[nodiscard]] EyeLight li(const World& world, const EyeSample& sample, const Hit& hit) const override;
};

/// Shows the share of light that surfaces scatter, seen from the eye.
struct AlbedoIntegrator final : ScalarIntegrator {
    explicit AlbedoIntegrator(const IntegratorSettings& settings) : ScalarIntegrator(settings, Shows::NoLight) {}
    [[nodiscard]] EyeLight li(const World& world, const EyeSample& sample, const Hit& hit) const override;
};

}  // namespace etendue
