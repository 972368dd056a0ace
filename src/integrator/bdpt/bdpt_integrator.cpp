#include "integrator/bdpt/bdpt_integrator.h"

#include "integrator/bdpt/bdpt_wave.h"

namespace etendue {

std::vector<std::string> BdptIntegrator::unreachable_light(const World& world) const {
    if (world.has_delta_lights() && world.has_specular_surfaces())
        return {
            "what point, spot and directional lights send through smooth glass or by way of mirrors cannot be found "
            "where the eye sees it in a mirror or through smooth glass, too"};
    return {};
}

std::unique_ptr<IntegratorScratch> BdptIntegrator::make_scratch() const {
    return std::make_unique<BdptWave>();
}

void BdptIntegrator::render_tile(const World& world, const TileJob& job, IntegratorScratch& scratch, TileBuffer& tile,
                                 RenderCounters& counters) const {
    trace_in_waves<BdptWave>(world, job, options_, scratch, tile, counters);
}

}  // namespace etendue
