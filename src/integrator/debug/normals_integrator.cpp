#include "integrator/debug/normals_integrator.h"

namespace etendue {

EyeLight NormalsIntegrator::li(const World& world, const EyeSample& sample, const Hit& hit) const {
    if (!hit.valid()) return {.alpha = 0.0f};
    const Vec3f n = 0.5f * world.geometry().surface_point(hit, sample.ray, sample.cone).shading.normal + Vec3f(0.5f);
    return {.seen = {n.x, n.y, n.z}};
}

}  // namespace etendue
