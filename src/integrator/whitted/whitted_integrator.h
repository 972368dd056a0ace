// Whitted's recursive ray tracing (Whitted, "An Improved Illumination Model for Shaded Display", Communications of the
// ACM 23(6), 1980): mirrored and refracted rays are both followed, a tree for each camera ray, and surfaces that
// scatter show direct light. Light that surfaces send to each other is left out, glossy reflections and caustics too:
// the historical baseline.
//
// Where the paper shades with Phong's model and point lights, surfaces here scatter with their lobe, and light comes
// from one point of one light, chosen as path tracing does.
#pragma once

#include "integrator/integrator.h"

namespace etendue {

class WhittedIntegrator final : public Integrator {
  public:
    /// Branches end by how little they contribute; `roulette_depth` is not used.
    explicit WhittedIntegrator(const PathLengths& lengths) : lengths_(lengths) {}

    [[nodiscard]] std::unique_ptr<IntegratorScratch> make_scratch() const override;
    [[nodiscard]] std::vector<std::string> unreachable_light(const World& world) const override;
    void render_tile(const World& world, const TileJob& job, IntegratorScratch& scratch, TileBuffer& tile,
                     RenderCounters& counters) const override;

  private:
    PathLengths lengths_;
};

}  // namespace etendue
