// Whitted's recursive ray tracing of transport/whitted.h, for tiles.
#pragma once

#include "integrator/scalar_integrator.h"

namespace etendue {

class WhittedIntegrator final : public ScalarIntegrator {
  public:
    explicit WhittedIntegrator(const IntegratorSettings& settings) : ScalarIntegrator(settings, Shows::Light) {}

    [[nodiscard]] std::vector<std::string> unreachable_light(const World& world) const override;
    [[nodiscard]] EyeLight li(const World& world, const EyeSample& sample, const Hit& hit) const override;
};

}  // namespace etendue
