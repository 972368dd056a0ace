#include "integrator/light/light_integrator.h"

#include "integrator/light/light_wave.h"
#include "integrator/trace_in_waves.h"

namespace etendue {

std::vector<std::string> LightIntegrator::unreachable_light(const World& world) const {
    std::vector<std::string> sentences;
    if (world.traits().has_specular_surfaces)
        sentences.emplace_back(
            "what the eye sees in mirrors or through smooth glass cannot be found by paths from the light and stays "
            "black; 'path' finds it");
    if (world.traits().has_environment && world.traits().environment_visible_to_camera)
        sentences.emplace_back(
            "the environment itself is not seen: paths from the light start there, and no camera can be connected to "
            "what is infinitely far away; 'path' finds it");
    if (world.traits().has_unlit_surfaces)
        sentences.emplace_back(
            "unlit surfaces (KHR_materials_unlit) stay black: they show their colour to the eye and send no light that "
            "a path could start with; 'path' finds it");
    if (world.traits().has_unsampled_emitters)
        sentences.emplace_back(
            "surfaces that glow and are not sampled (a note says why) start no paths from the light: neither they nor "
            "what they light is seen; 'path' finds this light");
    return sentences;
}

std::unique_ptr<IntegratorScratch> LightIntegrator::make_scratch() const {
    return std::make_unique<LightWave>();
}

void LightIntegrator::render_tile(const World& world, const TileJob& job, IntegratorScratch& scratch, TileBuffer& tile,
                                  RenderCounters& counters) const {
    trace_in_waves<LightWave>(world, job, settings_, scratch, tile, counters);
}

}  // namespace etendue
