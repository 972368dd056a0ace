#include "wave/ray_batch.h"

#include "wave/profile/wave_profile.h"

#include <algorithm>

namespace etendue {

namespace {

template <typename Batch>
void intersect_any(const World& world, const TileJob& job, RayKind kind, const Batch& rays, std::span<Hit> hits,
                   RenderCounters& counters, QueryForm form) {
    WaveProfile* profile = job.profile;
    if (profile != nullptr) profile->record(kind, rays);
    world.geometry().intersect(rays, hits, is_coherent(kind) ? Coherence::Coherent : Coherence::Incoherent, form);
    counters.rays[kind] += rays.size();
    if (profile == nullptr) return;
    profile->stamp(Stage::Intersect, kind);
    profile->count_hits(kind, static_cast<std::uint64_t>(std::ranges::count_if(hits, &Hit::valid)));
}

template <typename Batch>
void occluded_any(const World& world, const TileJob& job, RayKind kind, const Batch& rays,
                  std::span<std::uint8_t> occluded, RenderCounters& counters, QueryForm form) {
    WaveProfile* profile = job.profile;
    if (profile != nullptr) profile->record(kind, rays);
    world.geometry().occluded(rays, occluded, form);
    counters.rays[kind] += rays.size();
    if (profile == nullptr) return;
    profile->stamp(Stage::Occluded, kind);
    profile->count_hits(kind, static_cast<std::uint64_t>(std::ranges::count(occluded, kOccluded)));
}

}  // namespace

void intersect_batch(const World& world, const TileJob& job, RayKind kind, std::span<const Ray> rays,
                     std::span<Hit> hits, RenderCounters& counters) {
    intersect_any(world, job, kind, rays, hits, counters, QueryForm::Best);
}

void intersect_batch(const World& world, const TileJob& job, RayKind kind, const RayColumns& rays, std::span<Hit> hits,
                     RenderCounters& counters) {
    intersect_any(world, job, kind, rays, hits, counters, QueryForm::Best);
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
