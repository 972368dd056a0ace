// Path tracing: eye paths that meet light by next-event estimation and by chance, combined by multiple importance
// sampling (Kajiya 1986; Veach 1997, chapter 9; Russian roulette after Arvo and Kirk 1990).
//
// Written as steps over a wave of paths: generate, then per bounce intersect, shade, test shadow rays, add. Without
// light samples it is the naive path tracer, which finds lights by chance only.
#pragma once

#include "integrator/integrator.h"

namespace etendue {

class PathIntegrator final : public Integrator {
  public:
    /// With `leaves_out_indirect` it is `direct`, and notes that indirect light is left out, whatever the lengths are.
    explicit PathIntegrator(const IntegratorSettings& settings, bool leaves_out_indirect = false)
        : settings_(settings), leaves_out_indirect_(leaves_out_indirect) {}

    [[nodiscard]] std::unique_ptr<IntegratorScratch> make_scratch() const override;
    [[nodiscard]] std::vector<std::string> unreachable_light(const World& world) const override;
    [[nodiscard]] std::vector<std::string> ineffective_options(const World& world) const override;
    [[nodiscard]] std::unique_ptr<const LampImages> lamp_images(const World& world, const TileJob& whole,
                                                                const PixelRect& window) const override;
    void render_tile(const World& world, const TileJob& job, IntegratorScratch& scratch, TileBuffer& tile,
                     RenderCounters& counters) const override;

  private:
    IntegratorSettings settings_;
    bool leaves_out_indirect_;
};

}  // namespace etendue
