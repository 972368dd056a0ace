// Path tracing: eye paths that meet light by next-event estimation and by chance, combined by multiple importance
// sampling (Kajiya 1986; Veach 1997, chapter 9; Russian roulette after Arvo and Kirk 1990).
//
// Written as steps over a wave of paths: generate, then per bounce intersect, shade, test shadow rays, add. With
// `sample_lights` off it is the naive path tracer, which finds lights by chance only.
#pragma once

#include "integrator/integrator.h"

namespace etendue {

struct PathOptions {
    PathLengths lengths;
    bool sample_lights = true;
    /// Next-event splitting: lights sampled at each vertex that the eye sees directly or in mirrors and smooth glass,
    /// >= 1.
    std::uint32_t light_samples = 1;
    bool leaves_out_indirect = false;  ///< by its name, `direct`: it says so, whatever the lengths are
};

class PathIntegrator final : public Integrator {
  public:
    explicit PathIntegrator(const PathOptions& options) : options_(options) {}

    [[nodiscard]] std::unique_ptr<IntegratorScratch> make_scratch() const override;
    [[nodiscard]] std::vector<std::string> unreachable_light(const World& world) const override;
    [[nodiscard]] std::vector<std::string> ineffective_options(const World& world) const override;
    void render_tile(const World& world, const TileJob& job, IntegratorScratch& scratch, TileBuffer& tile,
                     RenderCounters& counters) const override;

  private:
    PathOptions options_;
};

}  // namespace etendue
