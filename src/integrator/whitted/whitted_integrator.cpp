#include "integrator/whitted/whitted_integrator.h"

#include "transport/whitted.h"

namespace etendue {

std::vector<std::string> WhittedIntegrator::unreachable_light(const World& world) const {
    std::vector<std::string> sentences{
        "light that surfaces which scatter receive from other surfaces (indirect light, glossy reflections, caustics) "
        "is left out; 'path' finds it"};
    if (world.traits().has_scattering_bodies)
        sentences.emplace_back("light that scatters within bodies is left out; 'path' finds it");
    if (world.traits().has_unsampled_emitters)
        sentences.emplace_back(
            "surfaces that glow and are not sampled, because they move while the shutter is open or are too many, are "
            "seen but light no surface; 'path' finds that light");
    return sentences;
}

EyeLight WhittedIntegrator::li(const World& world, const EyeSample& sample, const Hit& /*hit*/) const {
    return whitted_light(world, sample, settings());
}

}  // namespace etendue
