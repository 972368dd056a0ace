#include "integrator/bdpt/bdpt_integrator.h"

#include "integrator/bdpt/bdpt_wave.h"
#include "integrator/trace_in_waves.h"

#include <fmt/format.h>

namespace etendue {

std::vector<std::string> BdptIntegrator::unreachable_light(const World& world) const {
    std::vector<std::string> sentences;
    if (settings_.strategy && !world.has_bodies() && settings_.strategy->edges() > settings_.lengths.max_depth)
        sentences.push_back(fmt::format(
            "the image stays black: strategy {},{} makes paths of {} edges, and the longest that are kept have {}",
            settings_.strategy->s, settings_.strategy->t, settings_.strategy->edges(), settings_.lengths.max_depth));
    if (world.has_delta_lights() && world.has_specular_surfaces())
        sentences.emplace_back(
            "what point, spot and directional lights send through smooth glass or by way of mirrors cannot be found "
            "where the eye sees it in a mirror or through smooth glass, too");
    return sentences;
}

std::vector<std::string> BdptIntegrator::ineffective_options(const World& world) const {
    if (settings_.cached_connections == 0 || !world.has_motion()) return {};
    return {fmt::format(
        "connections to a cache (cache:{}) have no effect where something moves while the shutter is open: each sample "
        "has a time of its own, and is connected pairwise",
        settings_.cached_connections)};
}

std::unique_ptr<IntegratorScratch> BdptIntegrator::make_scratch() const {
    return std::make_unique<BdptWave>();
}

void BdptIntegrator::render_tile(const World& world, const TileJob& job, IntegratorScratch& scratch, TileBuffer& tile,
                                 RenderCounters& counters) const {
    auto& wave = static_cast<BdptWave&>(scratch);
    wave.start(world, job, settings_, observer_);
    trace_in_waves<BdptWave>(world, job, settings_, scratch, tile, counters);
    wave.finish(tile, counters);
}

}  // namespace etendue
