#include "integrator/path/path_integrator.h"

#include "integrator/path/path_wave.h"
#include "integrator/trace_in_waves.h"

#include <fmt/format.h>

namespace etendue {

std::vector<std::string> PathIntegrator::unreachable_light(const World& world) const {
    std::vector<std::string> notes;
    if (leaves_out_indirect_)
        notes.emplace_back("light that two surfaces or more have scattered is left out; 'path' finds it");
    if (world.traits().has_delta_lights && settings_.light_samples == 0)
        notes.emplace_back(
            "point, spot and directional lights are never met by chance: what they give is missing; "
            "'path' finds it");
    else if (world.traits().has_delta_lights && world.traits().has_specular_surfaces)
        notes.emplace_back(
            "what point, spot and directional lights send through smooth glass or by way of mirrors (their "
            "caustics) cannot be found by eye paths and is missing; 'light' finds it");
    return notes;
}

std::vector<std::string> PathIntegrator::ineffective_options(const World& world) const {
    // A vertex in a medium adds no edge.
    const int fewest = world.traits().samples_lights_in_media ? 1 : 2;
    if (settings_.light_samples <= 1 || (world.traits().has_sampled_lights && settings_.lengths.max_depth >= fewest))
        return {};
    return {fmt::format("{} light samples have no effect: {}", settings_.light_samples,
                        world.traits().has_sampled_lights
                            ? "paths have at most 1 edge (--max-depth)"
                            : "no light is sampled here, as the BSDF's samples find all best")};
}

std::unique_ptr<IntegratorScratch> PathIntegrator::make_scratch() const {
    return std::make_unique<PathWave>();
}

std::unique_ptr<const LampImages> PathIntegrator::lamp_images(const World& world, const TileJob& whole,
                                                              const PixelRect& window) const {
    // Without light samples, the integrator is there to find light by chance.
    if (!settings_.lamp_images || settings_.light_samples == 0) return nullptr;
    return find_lamp_images(world, whole, window);
}

void PathIntegrator::render_tile(const World& world, const TileJob& job, IntegratorScratch& scratch, TileBuffer& tile,
                                 RenderCounters& counters) const {
    LampsInView& lamps = static_cast<PathWave&>(scratch).lamps();
    lamps.start(world, job, settings_.lengths, true);
    trace_in_waves<PathWave>(world, job, settings_, scratch, tile, counters);
    lamps.finish(tile, counters);
}

}  // namespace etendue
