// Bidirectional path tracing: every path in every way that subpaths from the eye and from the light can make it,
// combined by multiple importance sampling (Lafortune and Willems 1993; Veach and Guibas 1994; Veach 1997, chapter 10).
//
// Each camera sample has a light subpath of its own, whose vertices are connected to those of the sample's eye subpath
// and to the camera. On request eye vertices are connected to a few of the vertices of all light subpaths of the wave
// instead (the light vertex cache of Davidovic et al., "Progressive Light Transport Simulation on the GPU: Survey and
// Improvements", 2014): each stands for as many as an average light subpath has per connection, and weights do not
// change, since the expected number of connections of each strategy does not. docs/derivations.md derives the
// weights. Textures are not filtered: subpaths from the light have no pixel to filter for, and both must see one
// material.
#pragma once

#include "integrator/integrator.h"

namespace etendue {

class BdptIntegrator final : public Integrator {
  public:
    explicit BdptIntegrator(const IntegratorSettings& settings) : settings_(settings) {}

    [[nodiscard]] std::unique_ptr<IntegratorScratch> make_scratch() const override;
    [[nodiscard]] std::vector<std::string> unreachable_light(const World& world) const override;
    [[nodiscard]] std::vector<std::string> ineffective_options(const World& world) const override;
    [[nodiscard]] bool makes_splats() const override { return true; }
    [[nodiscard]] Merging merging(const World& world, const TileJob& job) const override;
    [[nodiscard]] std::unique_ptr<const LampImages> lamp_images(const World& world, const TileJob& whole,
                                                                const PixelRect& window) const override;
    void trace_photons(const World& world, const TileJob& job, IntegratorScratch& scratch, PhotonList& photons,
                       RenderCounters& counters) const override;
    void render_tile(const World& world, const TileJob& job, IntegratorScratch& scratch, TileBuffer& tile,
                     RenderCounters& counters) const override;

  private:
    /// Returns false if no vertices of `world` merge, whichever strategies make the image.
    [[nodiscard]] bool may_merge(const World& world) const;

    IntegratorSettings settings_;
};

}  // namespace etendue
