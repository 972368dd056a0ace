#include "wave/ray_batch.h"

#include "wave/profile/wave_profile.h"
#include "world/lit_surface.h"

#include <algorithm>

namespace etendue {

namespace {

/// Has `intersect` find what `rays` hit, counts them, and times it for a profile.
template <typename Batch, typename Intersect>
void count_intersections(const TileJob& job, RayKind kind, const Batch& rays, std::span<const Hit> hits,
                         RenderCounters& counters, const Intersect& intersect) {
    WaveProfile* profile = job.profile;
    if (profile != nullptr) profile->record(kind, rays);
    intersect();
    counters.rays[kind] += rays.size();
    if (profile == nullptr) return;
    profile->clock().stamp(Stage::Intersect, kind);
    profile->count_hits(kind, static_cast<std::uint64_t>(std::ranges::count_if(hits, &Hit::valid)));
}

template <typename Batch>
void intersect_any(const World& world, const TileJob& job, RayKind kind, const Batch& rays, std::span<Hit> hits,
                   RenderCounters& counters, QueryForm form) {
    count_intersections(job, kind, rays, hits, counters, [&] {
        const Coherence coherence = is_coherent(kind) ? Coherence::Coherent : Coherence::Incoherent;
        world.geometry().intersect(rays, hits, coherence, form, ends_of(kind));
    });
}

template <typename Batch>
void occluded_any(const World& world, const TileJob& job, RayKind kind, const Batch& rays,
                  std::span<std::uint8_t> occluded, RenderCounters& counters, QueryForm form) {
    WaveProfile* profile = job.profile;
    if (profile != nullptr) profile->record(kind, rays);
    world.geometry().occluded(rays, occluded, form, ends_of(kind));
    counters.rays[kind] += rays.size();
    if (profile == nullptr) return;
    profile->clock().stamp(Stage::Occluded, kind);
    profile->count_hits(kind, static_cast<std::uint64_t>(std::ranges::count(occluded, kOccluded)));
}

}  // namespace

RayEnds ends_of(RayKind kind) {
    if (kind == RayKind::LightToCamera) return RayEnds::ToCamera;
    return kind == RayKind::Primary || kind == RayKind::LampInView ? RayEnds::AtCamera : RayEnds::InScene;
}

void intersect_batch(const World& world, const TileJob& job, RayKind kind, std::span<const Ray> rays,
                     std::span<Hit> hits, RenderCounters& counters) {
    intersect_any(world, job, kind, rays, hits, counters, QueryForm::Best);
}

void intersect_batch(const World& world, const TileJob& job, RayKind kind, const RayColumns& rays, std::span<Hit> hits,
                     RenderCounters& counters) {
    intersect_any(world, job, kind, rays, hits, counters, QueryForm::Best);
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

void occluded_batch(const World& world, const TileJob& job, RayKind kind, const RayColumns& rays,
                    std::span<std::uint8_t> occluded, RenderCounters& counters) {
    occluded_any(world, job, kind, rays, occluded, counters, QueryForm::Best);
}

Hit intersect_one(const World& world, const TileJob& job, RayKind kind, const Ray& ray, RenderCounters& counters) {
    Hit hit;
    intersect_any(world, job, kind, std::span(&ray, 1), std::span(&hit, 1), counters, QueryForm::Single);
    return hit;
}

std::uint8_t occluded_one(const World& world, const TileJob& job, RayKind kind, const Ray& ray,
                          RenderCounters& counters) {
    std::uint8_t occluded = kFree;
    occluded_any(world, job, kind, std::span(&ray, 1), std::span(&occluded, 1), counters, QueryForm::Single);
    return occluded;
}

}  // namespace etendue
