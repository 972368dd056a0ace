// The integrators that trace one sample after the other.
#pragma once

#include "integrator/scalar_integrator.h"

namespace etendue {

/// Traces rays as Whitted did (transport/whitted.h).
struct WhittedIntegrator final : ScalarIntegrator {
    explicit WhittedIntegrator(const IntegratorSettings& settings) : ScalarIntegrator(settings, Shows::Light) {}
    [[nodiscard]] std::vector<std::string> unreachable_light(const World& world) const override;
    [[nodiscard]] EyeLight li(const World& world, const EyeSample& sample, const Hit& hit) const override;
};

/// Shows, for debugging, shading normals in world space in place of light, each component mapped from [-1, 1] to
/// [0, 1].
struct NormalsIntegrator final : ScalarIntegrator {
    explicit NormalsIntegrator(const IntegratorSettings& settings) : ScalarIntegrator(settings, Shows::NoLight) {}
    [[nodiscard]] EyeLight li(const World& world, const EyeSample& sample, const Hit& hit) const override;
};

/// Shows, for debugging, albedo in place of light: the share of light that the surface seen from the eye scatters.
struct AlbedoIntegrator final : ScalarIntegrator {
    explicit AlbedoIntegrator(const IntegratorSettings& settings) : ScalarIntegrator(settings, Shows::NoLight) {}
    [[nodiscard]] EyeLight li(const World& world, const EyeSample& sample, const Hit& hit) const override;
};

}  // namespace etendue
