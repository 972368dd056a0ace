// Light tracing: subpaths from the lights, each vertex of which is connected to the camera (Arvo 1986; Dutré, Lafortune
// and Willems 1993; Veach 1997, chapter 10, the strategies with one vertex on the camera).
//
// What path tracing cannot find it finds soon, caustics of the smallest lights above all; what the eye sees in mirrors
// it cannot find at all.
#pragma once

#include "integrator/integrator.h"

namespace etendue {

class LightIntegrator final : public Integrator {
  public:
    explicit LightIntegrator(const IntegratorSettings& settings) : settings_(settings) {}

    [[nodiscard]] std::unique_ptr<IntegratorScratch> make_scratch() const override;
    [[nodiscard]] std::vector<std::string> unreachable_light(const World& world) const override;
    [[nodiscard]] bool makes_splats() const override { return true; }
    void render_tile(const World& world, const TileJob& job, IntegratorScratch& scratch, TileBuffer& tile,
                     RenderCounters& counters) const override;

  private:
    IntegratorSettings settings_;
};

}  // namespace etendue
