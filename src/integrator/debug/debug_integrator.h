// What the eye meets first, without light transport: for finding out what is wrong with a scene.
#pragma once

#include "integrator/integrator.h"

namespace etendue {

enum class DebugQuantity {
    Normals,  ///< shading normal in world space, each component mapped from [-1, 1] to [0, 1]
    Albedo,   ///< share of light that the surface scatters, seen from the eye
};

class DebugIntegrator final : public Integrator {
  public:
    explicit DebugIntegrator(DebugQuantity quantity) : quantity_(quantity) {}

    [[nodiscard]] std::unique_ptr<IntegratorScratch> make_scratch() const override;
    [[nodiscard]] std::vector<std::string> unreachable_light(const World&) const override { return {}; }
    void render_tile(const World& world, const TileJob& job, IntegratorScratch& scratch, TileBuffer& tile,
                     RenderCounters& counters) const override;

  private:
    [[nodiscard]] Rgb value(const World& world, const TileJob& job, const Ray& ray, const Hit& hit,
                            SampleKey key) const;

    DebugQuantity quantity_;
};

}  // namespace etendue
