#include "integrator/debug/debug_integrators.h"

#include "wave/aov/surface_albedo.h"

namespace etendue {

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
