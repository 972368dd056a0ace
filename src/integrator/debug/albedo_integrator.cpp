#include "integrator/debug/albedo_integrator.h"

#include "world/scattering.h"

namespace etendue {

namespace {

/// Counts the samples of a hit's estimate, whose noise averages out over the samples of the pixel.
constexpr int kAlbedoSamples = 4;

}  // namespace

EyeLight AlbedoIntegrator::li(const World& world, const EyeSample& sample, const Hit& hit) const {
    if (!hit.valid()) return {.alpha = 0.0f};
    const SurfacePoint point = world.geometry().surface_point(hit, sample.ray, sample.cone);
    if (point.material->unlit) return {.seen = world.materials().unlit_color(point)};
    const Vec3f wo = -sample.ray.direction;
    Bsdf storage;
    const Scattering scattering(world.materials().bsdf(point, wo, 0.0f, storage), point.shading, point.geometric_normal,
                                wo);
    return {.seen = estimate_albedo(scattering.bsdf(), scattering.wo_local(), kAlbedoSamples,
                                    sample.numbers.bits(kFirstFreeDimension))};
}

}  // namespace etendue
