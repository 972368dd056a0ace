// How integrators trace: batches of one kind of rays, or single ones, counted, and timed where a profile is wanted.
#pragma once

#include "wave/aov/sample_light.h"
#include "wave/profile/wave_profile.h"
#include "wave/ray_kind.h"
#include "wave/render_counters.h"
#include "wave/tile_job.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace etendue {

/// Returns which ends rays of `kind` have.
[[nodiscard]] RayEnds ends_of(RayKind kind);

/// Lets `intersect` find what `rays` hit, counts the rays, and times the search for a profile.
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

/// Finds the nearest surfaces along rays of one kind, in a span or in RayColumns; `hits` is as long as `rays`.
template <typename Batch>
void intersect_batch(const World& world, const TileJob& job, RayKind kind, const Batch& rays, std::span<Hit> hits,
                     RenderCounters& counters, QueryForm form = QueryForm::Best) {
    count_intersections(job, kind, rays, hits, counters, [&] {
        const Coherence coherence = is_coherent(kind) ? Coherence::Coherent : Coherence::Incoherent;
        world.geometry().intersect(rays, hits, coherence, form, ends_of(kind));
    });
}

/// Finds what rays of light paths light where backs are culled: see `find_lit_surface`. All spans are as long as
/// `rays`.
void intersect_lit(const World& world, const TileJob& job, std::span<const Ray> rays, std::span<Hit> hits,
                   std::span<float> counts, RenderCounters& counters);

/// Removes the hits of rays from the camera that it does not show: those that lie too far, as `SceneCamera::cut_far`
/// does, and all of rays that come from where the film sees nothing.
inline void hide_unseen_hits(const World& world, std::span<const Ray> rays, std::span<Hit> hits) {
    if (!world.traits().clips_far && !world.traits().has_blind_film) return;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!(rays[i].t_max > 0.0f)) hits[i] = {};
        if (world.traits().clips_far) hits[i] = world.camera().cut_far(rays[i], hits[i]);
    }
}

/// Answers for each ray as `SceneGeometry::occluded` does: kOccluded, kPassesClear or kFree; `occluded` is as long as
/// `rays`.
template <typename Batch>
void occluded_batch(const World& world, const TileJob& job, RayKind kind, const Batch& rays,
                    std::span<std::uint8_t> occluded, RenderCounters& counters, QueryForm form = QueryForm::Best) {
    WaveProfile* profile = job.profile;
    if (profile != nullptr) profile->record(kind, rays);
    world.geometry().occluded(rays, occluded, form, ends_of(kind));
    counters.rays[kind] += rays.size();
    if (profile == nullptr) return;
    profile->clock().stamp(Stage::Occluded, kind);
    profile->count_hits(kind, static_cast<std::uint64_t>(std::ranges::count(occluded, kOccluded)));
}

/// Returns the nearest surface along `ray`, as `intersect_batch` does along many.
[[nodiscard]] Hit intersect_one(const World& world, const TileJob& job, RayKind kind, const Ray& ray,
                                RenderCounters& counters);
/// Returns what is in the way of `ray`, as `occluded_batch` does for many.
[[nodiscard]] std::uint8_t occluded_one(const World& world, const TileJob& job, RayKind kind, const Ray& ray,
                                        RenderCounters& counters);

/// Returns the hit that the camera sees along `ray`, which has passed only clear surfaces, if any, and has met `hit`:
/// the nearest that is not hidden from the camera, or none if it lies beyond the camera's clipping distance. If another
/// ray is traced to find the hit, this ray counts for the sample in `slot` of `light`.
[[nodiscard]] inline Hit hit_seen_by_camera(const World& world, const TileJob& job, const Ray& ray, const Hit& hit,
                                            std::uint32_t slot, SampleLight& light, RenderCounters& counters) {
    Hit shown = hit;
    if (world.materials().is_hidden_from_camera(hit)) {
        shown = intersect_one(world, job, RayKind::Primary, ray, counters);
        light.count_ray(slot);
    }
    return world.traits().clips_far ? world.camera().cut_far(ray, shown) : shown;
}

}  // namespace etendue
