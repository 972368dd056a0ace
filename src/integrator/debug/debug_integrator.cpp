#include "integrator/debug/debug_integrator.h"

#include "transport/scattered_cone.h"
#include "wave/aov/first_hits.h"
#include "wave/camera_wave.h"
#include "wave/ray_batch.h"
#include "world/scattering.h"

#include <algorithm>

namespace etendue {

namespace {

struct DebugScratch final : IntegratorScratch {
    static constexpr std::size_t kCapacity = 1024;
    std::vector<CameraSample> samples = std::vector<CameraSample>(kCapacity);
    std::vector<Ray> rays = std::vector<Ray>(kCapacity);
    SampleLight found;
    std::vector<float> alpha = std::vector<float>(kCapacity);
    std::vector<Hit> hits = std::vector<Hit>(kCapacity);

    [[nodiscard]] std::size_t bytes() const override {
        return sizeof *this + vector_bytes(samples, rays, alpha, hits) + found.bytes();
    }
};

/// Samples per hit of the albedo estimate; its noise averages out over the pixel's samples.
constexpr int kAlbedoSamples = 4;

}  // namespace

std::unique_ptr<IntegratorScratch> DebugIntegrator::make_scratch() const {
    return std::make_unique<DebugScratch>();
}

void DebugIntegrator::render_tile(const World& world, const TileJob& job, IntegratorScratch& scratch, TileBuffer& tile,
                                  RenderCounters& counters) const {
    auto& s = static_cast<DebugScratch&>(scratch);
    const std::size_t total = camera_sample_count(job);
    for (std::size_t first = 0; first < total; first += DebugScratch::kCapacity) {
        const std::size_t count = std::min(DebugScratch::kCapacity, total - first);
        const auto rays = std::span(s.rays).first(count);
        const auto hits = std::span(s.hits).first(count);
        generate_camera_rays(world, job, first, std::span(s.samples).first(count), rays);
        intersect_batch(world, job, RayKind::Primary, rays, hits, counters);
        find_first_hits(world, job, std::span(s.samples).first(count), rays, hits, tile);
        s.found.reset(count, job, counters.brightest.threshold());
        for (std::uint32_t i = 0; i < count; ++i) {
            s.found.count_ray(i);
            s.alpha[i] = hits[i].valid() ? 1.0f : 0.0f;
            if (hits[i].valid()) s.found.add(i, value(world, job, rays[i], hits[i], s.samples[i].key), LightKind::Seen);
        }
        accumulate(job, std::span(s.samples).first(count), s.found, s.alpha, tile, counters);
    }
}

Rgb DebugIntegrator::value(const World& world, const TileJob& job, const Ray& ray, const Hit& hit,
                           SampleKey key) const {
    const SurfacePoint point = world.surface_point(hit, ray, camera_cone(world, job.full_width, job.full_height, ray));
    if (quantity_ == DebugQuantity::Normals) {
        const Vec3f n = point.shading.normal;
        return {0.5f * n.x + 0.5f, 0.5f * n.y + 0.5f, 0.5f * n.z + 0.5f};
    }
    if (point.material->unlit) return world.unlit_color(point);
    Bsdf storage;
    const Scattering scattering(world.bsdf(point, -ray.direction, 0.0f, storage), point.shading, point.geometric_normal,
                                -ray.direction);
    return estimate_albedo(scattering.bsdf(), scattering.wo_local(), kAlbedoSamples,
                           sample_bits(key, kFirstFreeDimension));
}

}  // namespace etendue
