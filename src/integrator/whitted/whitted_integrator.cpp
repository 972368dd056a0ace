#include "integrator/whitted/whitted_integrator.h"

#include "integrator/trace_in_waves.h"
#include "integrator/whitted/whitted_wave.h"

namespace etendue {

std::vector<std::string> WhittedIntegrator::unreachable_light(const World& world) const {
    std::vector<std::string> sentences{
        "light that surfaces which scatter receive from other surfaces (indirect light, glossy reflections, caustics) "
        "is left out; 'path' finds it"};
    if (world.has_scattering_bodies())
        sentences.emplace_back("light that scatters within bodies is left out; 'path' finds it");
    if (world.has_unsampled_emitters())
        sentences.emplace_back(
            "surfaces that glow and are not sampled, because they move while the shutter is open or are too many, are "
            "seen but light no surface; 'path' finds that light");
    return sentences;
}

std::unique_ptr<IntegratorScratch> WhittedIntegrator::make_scratch() const {
    return std::make_unique<WhittedWave>();
}

void WhittedIntegrator::render_tile(const World& world, const TileJob& job, IntegratorScratch& scratch,
                                    TileBuffer& tile, RenderCounters& counters) const {
    LampsInView& lamps = static_cast<WhittedWave&>(scratch).lamps();
    lamps.start(world, job, lengths_, true);
    trace_in_waves<WhittedWave>(world, job, lengths_, scratch, tile, counters);
    lamps.finish(tile, counters);
}

}  // namespace etendue
