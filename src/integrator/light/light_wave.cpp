#include "integrator/light/light_wave.h"

#include "transport/bodies.h"
#include "transport/connecting_ray.h"
#include "wave/aov/first_hits.h"
#include "wave/profile/wave_profile.h"
#include "wave/ray_batch.h"

namespace etendue {

std::size_t LightWave::bytes() const {
    return sizeof *this + vector_bytes(samples_, camera_rays_, hits_, alpha_, shares_) + found_.bytes() +
           subpaths_.bytes() + to_camera_.bytes() + lamps_.bytes() + connections_.bytes();
}

void LightWave::trace(const World& world, const TileJob& job, const IntegratorSettings& settings, std::size_t first,
                      std::size_t count, TileBuffer& tile, RenderCounters& counters) {
    // Their keys and times; a light path is made for each.
    samples_.resize(count);
    camera_rays_.resize(count);
    generate_camera_rays(world, job, first, samples_, camera_rays_);
    found_.reset(count, job, counters.brightest.threshold());
    if (job.aovs != nullptr && job.aovs->needs_first_hits()) {
        hits_.resize(count);
        intersect_batch(world, job, RayKind::Primary, camera_rays_, hits_, counters);
        hide_unseen_hits(world, camera_rays_, hits_);
        find_first_hits(world, job, samples_, camera_rays_, hits_, tile);
    }
    stamp(job.profile, Stage::Generate);
    if (world.traits().has_lights) trace_subpaths(world, job, settings, tile, counters);
    // No path from the light tells what the camera sees through: the image is opaque.
    alpha_.assign(count, 1.0f);
    accumulate(job, samples_, found_, alpha_, tile, counters);
    stamp(job.profile, Stage::Film);
}

void LightWave::trace_subpaths(const World& world, const TileJob& job, const IntegratorSettings& settings,
                               TileBuffer& tile, RenderCounters& counters) {
    const PathLengths& lengths = settings.lengths;
    const SubpathJob subpath_job{.mis = mis_context(world, job, settings),
                                 .job = job,
                                 .lengths = lengths,
                                 .samples = samples_,
                                 .camera_rays = camera_rays_};
    subpaths_.trace(subpath_job, lengths.roulette_depth, nullptr, found_, counters);
    if (lengths.is_long_enough(1))
        lamps_.connect(subpath_job, subpaths_, connections_,
                       [](const Emission&, const CameraConnection&, float) { return 1.0f; });
    connect_vertices(subpath_job, tile, counters);
    stamp(job.profile, Stage::Material);
    connections_.resolve(world, job, samples_, found_, tile, counters);
}

void LightWave::connect_vertices(const SubpathJob& job, TileBuffer& tile, RenderCounters& counters) {
    to_camera_.collect(job, SubpathEnd::AtLight, subpaths_);
    for (std::size_t i = 0; i < to_camera_.size(); ++i) {
        const PathVertex& vertex = subpaths_.vertices().whole(to_camera_[i]);
        if (!vertex.lights_camera || !job.lengths.is_long_enough(vertex.next_edges)) continue;
        const float time = camera_rays_[vertex.slot].time;
        const auto [lens] = to_camera_.numbers(i);
        const auto view = view_from_camera(job.world(), job.job, vertex.position, lens, time);
        if (!view) continue;
        const Rgb scattered = vertex.evaluate(view->direction, TransportMode::Importance);
        if (is_black(scattered)) continue;
        Ray ray = job.timed(connecting_ray(vertex.origin(view->direction), view->camera.lens), vertex.slot);
        ray.alpha_key = job.connection_key(SubpathEnd::AtLight, vertex.index, vertex.slot);
        shares_.clear();
        if (subpaths_.vertices().words().are_followed())
            subpaths_.vertices().words().end_at_camera(subpaths_.vertices().words_after(vertex, view->direction),
                                                       shares_);
        connections_.to_film(
            ray, vertex.slot,
            {.position = view->pixel,
             .value = vertex.throughput * scattered * job.wavelength_weight(vertex.slot, vertex.is_dispersed) *
                      subpaths_.vertices().transmittance(job.world(), vertex, ray, view->distance, RayEnds::ToCamera) *
                      view->camera.importance_area,
             .depth = view->depth},
            vertex.index > 1 ? LightKind::Indirect : LightKind::Direct, shares_);
        if (!connections_.is_full()) continue;
        stamp(job.job.profile, Stage::Material);
        connections_.resolve(job.world(), job.job, samples_, found_, tile, counters);
    }
}

}  // namespace etendue
