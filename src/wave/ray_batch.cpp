#include "wave/ray_batch.h"

#include "world/lit_surface.h"

namespace etendue {

RayEnds ends_of(RayKind kind) {
    if (kind == RayKind::LightToCamera) return RayEnds::ToCamera;
    return kind == RayKind::Primary || kind == RayKind::LampInView ? RayEnds::AtCamera : RayEnds::InScene;
}

void intersect_lit(const World& world, const TileJob& job, std::span<const Ray> rays, std::span<Hit> hits,
                   std::span<float> counts, RenderCounters& counters) {
    count_intersections(job, RayKind::LightSubpath, rays, hits, counters, [&] {
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const LitSurface lit = find_lit_surface(world, rays[i]);
            hits[i] = lit.hit;
            counts[i] = lit.count;
        }
    });
}

Hit intersect_one(const World& world, const TileJob& job, RayKind kind, const Ray& ray, RenderCounters& counters) {
    Hit hit;
    intersect_batch(world, job, kind, std::span(&ray, 1), std::span(&hit, 1), counters, QueryForm::Single);
    return hit;
}

std::uint8_t occluded_one(const World& world, const TileJob& job, RayKind kind, const Ray& ray,
                          RenderCounters& counters) {
    std::uint8_t occluded = kFree;
    occluded_batch(world, job, kind, std::span(&ray, 1), std::span(&occluded, 1), counters, QueryForm::Single);
    return occluded;
}

}  // namespace etendue
