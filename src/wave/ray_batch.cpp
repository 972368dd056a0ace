#include "wave/ray_batch.h"

#include "wave/profile/wave_profile.h"

#include <algorithm>

namespace etendue {

namespace {

template <typename Batch>
void intersect_any(const World& world, const TileJob& job, RayKind kind, const Batch& rays, std::span<Hit> hits,
                   RenderCounters& counters) {
    WaveProfile* profile = job.profile;
    if (profile != nullptr) profile->record(kind, rays);
    world.intersect(rays, hits, is_coherent(kind) ? Coherence::Coherent : Coherence::Incoherent);
    counters.rays[kind] += rays.size();
    if (profile == nullptr) return;
    profile->stamp(Stage::Intersect, kind);
    profile->count_hits(kind, static_cast<std::uint64_t>(std::ranges::count_if(hits, &Hit::valid)));
}

}  // namespace

void intersect_batch(const World& world, const TileJob& job, RayKind kind, std::span<const Ray> rays,
                     std::span<Hit> hits, RenderCounters& counters) {
    intersect_any(world, job, kind, rays, hits, counters);
}

void intersect_batch(const World& world, const TileJob& job, RayKind kind, const RayColumns& rays, std::span<Hit> hits,
                     RenderCounters& counters) {
    intersect_any(world, job, kind, rays, hits, counters);
}

void occluded_batch(const World& world, const TileJob& job, RayKind kind, const RayColumns& rays,
                    std::span<std::uint8_t> occluded, RenderCounters& counters) {
    WaveProfile* profile = job.profile;
    if (profile != nullptr) profile->record(kind, rays);
    world.occluded(rays, occluded);
    counters.rays[kind] += rays.size();
    if (profile == nullptr) return;
    profile->stamp(Stage::Occluded, kind);
    profile->count_hits(kind, static_cast<std::uint64_t>(std::ranges::count(occluded, kOccluded)));
}

}  // namespace etendue
