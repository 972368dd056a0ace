// The base of integrators that need no speed: each traces one sample after the other.
#pragma once

#include "integrator/integrator.h"
#include "transport/walk.h"

namespace etendue {

/// Renders by a function of one sample. Camera rays are traced together before; samples, alpha, layers, lamps in view
/// and counts are taken care of.
class ScalarIntegrator : public Integrator {
  public:
    [[nodiscard]] std::unique_ptr<IntegratorScratch> make_scratch() const override;
    void render_tile(const World& world, const TileJob& job, IntegratorScratch& scratch, TileBuffer& tile,
                     RenderCounters& counters) const override;

    /// Returns what `sample` finds, whose ray from the camera has met `hit`. All further rays go through
    /// `sample.tracer`, as the functions of transport/walk.h and transport/direct_light.h send them.
    [[nodiscard]] virtual EyeLight li(const World& world, const EyeSample& sample, const Hit& hit) const = 0;

  protected:
    /// Says what `li` returns; it finds light that it meets by `met_light`, which leaves lamps in view to this class.
    enum class Shows { Light, NoLight };

    ScalarIntegrator(const IntegratorSettings& settings, Shows shows) : settings_(settings), shows_(shows) {}

    [[nodiscard]] const IntegratorSettings& settings() const { return settings_; }

  private:
    IntegratorSettings settings_;
    Shows shows_;
};

}  // namespace etendue
