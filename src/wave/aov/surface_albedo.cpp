#include "wave/aov/surface_albedo.h"

#include "transport/bodies.h"
#include "world/scattering.h"

#include <optional>

namespace etendue {

namespace {

/// Begins the dimensions of albedos, far from those of paths.
constexpr std::uint32_t kAlbedoDimension = 7u << 28;
/// Counts the samples of an estimate, whose noise averages out over the samples of the pixel.
constexpr std::uint32_t kAlbedoSamples = 4;

}  // namespace

SurfaceAlbedo surface_albedo(const World& world, SurfacePoint& point, const Ray& ray, const Hit& hit,
                             const SampleNumbers& numbers) {
    SurfaceAlbedo albedo;
    if (point.material->unlit) return albedo;
    const Vec3f wo = -ray.direction;
    const std::optional<Crossing> crossing =
        crossing_at(world, point, {ray, world.media().interior_at_camera(ray), hit});
    Bsdf storage;
    const Bsdf& bsdf = world.materials().bsdf(point, wo, crossing ? crossing->relative_ior(0.0f) : 0.0f, storage);
    const Scattering scattering(bsdf, point.shading, point.geometric_normal, wo);
    for (std::uint32_t i = 0; i < kAlbedoSamples; ++i) {
        const auto number = [&](std::uint32_t which) { return numbers.pair(kAlbedoDimension + 2 * i + which); };
        // Radiance is scaled where it enters glass, which is no albedo. Nor is importance with its factor of shading
        // normals, which may be anything.
        const BsdfSample s = scattering.sample(number(0).x, number(1), TransportMode::Radiance);
        if (is_black(s.weight)) continue;
        const Rgb weight = s.weight * ((s.is_transmission ? s.eta * s.eta : 1.0f) / kAlbedoSamples);
        const Rgb diffuse = s.is_delta ? Rgb() : scattering.diffuse_share(s.wi, TransportMode::Radiance) * weight;
        albedo.diffuse += diffuse;
        albedo.specular += weight - diffuse;
    }
    return albedo;
}

}  // namespace etendue
