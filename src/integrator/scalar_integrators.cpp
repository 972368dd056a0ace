#include "integrator/scalar_integrators.h"

#include "transport/whitted.h"
#include "wave/aov/surface_albedo.h"

namespace etendue {

std::vector<std::string> WhittedIntegrator::unreachable_light(const World& world) const {
    std::vector<std::string> sentences{
        "light that surfaces which scatter receive from other surfaces (indirect light, glossy reflections, caustics) "
        "is left out; 'path' finds it"};
    if (world.traits().has_scattering_bodies)
        sentences.emplace_back("light that scatters within bodies is left out; 'path' finds it");
    if (world.traits().has_unsampled_emitters)
        sentences.emplace_back(
            "surfaces that glow and are not sampled (a note says why) are seen but light no surface; 'path' finds that "
            "light");
    return sentences;
}

EyeLight WhittedIntegrator::li(const World& world, const EyeSample& sample, const Hit& /*hit*/) const {
    return whitted_light(world, sample, settings());
}

EyeLight NormalsIntegrator::li(const World& world, const EyeSample& sample, const Hit& hit) const {
    if (!hit.valid()) return {.alpha = 0.0f};
    const Vec3f n = 0.5f * world.geometry().surface_point(hit, sample.ray, sample.cone).shading.normal + Vec3f(0.5f);
    return {.seen = {n.x, n.y, n.z}};
}

EyeLight AlbedoIntegrator::li(const World& world, const EyeSample& sample, const Hit& hit) const {
    if (!hit.valid()) return {.alpha = 0.0f};
    SurfacePoint point = world.geometry().surface_point(hit, sample.ray, sample.cone);
    if (point.material->unlit) return {.seen = world.materials().unlit_color(point)};
    const SurfaceAlbedo albedo = surface_albedo(world, point, sample.ray, hit, sample.numbers);
    return {.seen = albedo.diffuse + albedo.specular};
}

}  // namespace etendue
