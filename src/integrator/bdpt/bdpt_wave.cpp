#include "integrator/bdpt/bdpt_wave.h"

#include "integrator/bdpt/met_light.h"
#include "transport/roulette.h"
#include "wave/aov/first_hits.h"
#include "wave/profile/wave_profile.h"

#include <algorithm>
#include <cmath>

namespace etendue {

std::size_t BdptWave::bytes() const {
    return sizeof *this +
           vector_bytes(samples_, camera_rays_, alpha_, shares_, to_lights_, to_cameras_, between_, receivers_,
                        choosing_, choices_, lit_, wide_to_lights_, wide_to_cameras_) +
           found_.bytes() + lamps_.bytes() + eye_.bytes() + light_.bytes() + lamps_to_camera_.bytes() +
           light_vertices_.bytes() + to_light_.bytes() + to_camera_.bytes() + light_connections_.bytes() +
           wide_light_connections_.bytes() + camera_connections_.bytes() + wide_camera_connections_.bytes() +
           vertex_connections_.bytes() + wide_vertex_connections_.bytes();
}

void BdptWave::trace(const World& world, const TileJob& job, const IntegratorSettings& settings, std::size_t first,
                     std::size_t count, TileBuffer& tile, RenderCounters& counters) {
    samples_.resize(count);
    camera_rays_.resize(count);
    // The samples of a wave share the cache.
    generate_camera_rays(world, job, first, samples_, camera_rays_,
                         settings.cached_connections > 0 ? SampleOrder::SampleBySample : SampleOrder::PixelByPixel);
    found_.reset(count, job, counters.brightest.threshold());
    alpha_.assign(count, 1.0f);
    const BdptJob bdpt{{.mis = mis_context(world, job, settings),
                        .job = job,
                        .lengths = settings.lengths,
                        .samples = samples_,
                        .camera_rays = camera_rays_},
                       settings};
    const SparedRays spared = spared_rays(settings.lengths.roulette_depth);
    MetLight met({bdpt, eye_, lamps_, found_, alpha_, tile, counters});
    eye_.trace(bdpt, spared.of_eye, &met, found_, counters);
    if (world.traits().has_lights) {
        light_.trace(bdpt, spared.of_light, nullptr, found_, counters);
        if (bdpt.lengths.keeps(1) && bdpt.wants({.s = 1, .t = 1}))
            lamps_to_camera_.connect(bdpt, light_, camera_connections_,
                                     [&](const Emission& emission, const CameraConnection& camera, float cosine) {
                                         return bdpt.weight(sums_of_seen_light(bdpt.mis, emission, camera, cosine));
                                     });
        light_vertices_.collect(bdpt, light_.vertices().connectible());
        stamp(job.profile, Stage::Mis);
        to_light_.collect(bdpt, SubpathEnd::AtEye, eye_);
        stamp(job.profile, Stage::Numbers);
        for (std::size_t begin = 0; begin < to_light_.size(); begin += kBlockLanes) {
            const std::size_t end = std::min(begin + kBlockLanes, to_light_.size());
            if (world.traits().has_sampled_lights) connect_to_lights(bdpt, begin, end);
            resolve_full(bdpt, {&light_connections_, &wide_light_connections_}, tile, counters);
            connect_to_vertices(bdpt, begin, end, tile, counters);
        }
        to_camera_.collect(bdpt, SubpathEnd::AtLight, light_);
        stamp(job.profile, Stage::Numbers);
        for (std::size_t begin = 0; begin < to_camera_.size(); begin += kBlockLanes) {
            connect_to_camera(bdpt, begin, std::min(begin + kBlockLanes, to_camera_.size()));
            resolve_full(bdpt, {&camera_connections_, &wide_camera_connections_}, tile, counters);
        }
        if (job.photons != nullptr && bdpt.wants(kMerges)) merge(bdpt);
        for (ShadowRayQueue* connections : {&light_connections_, &wide_light_connections_, &vertex_connections_,
                                            &wide_vertex_connections_, &camera_connections_, &wide_camera_connections_})
            connections->resolve(world, job, samples_, found_, tile, counters);
    }
    lamps_.note_radiance(samples_, found_);
    accumulate(job, samples_, found_, alpha_, tile, counters);
    stamp(job.profile, Stage::Film);
}

void BdptWave::resolve_full(const BdptJob& job, std::initializer_list<ShadowRayQueue*> queues, TileBuffer& tile,
                            RenderCounters& counters) {
    for (ShadowRayQueue* const connections : queues)
        if (connections->is_full()) connections->resolve(job.world(), job.job, samples_, found_, tile, counters);
}

void BdptWave::trace_photons(const World& world, const TileJob& job, const IntegratorSettings& settings,
                             std::size_t first, std::size_t count, PhotonList& photons, RenderCounters& counters) {
    samples_.resize(count);
    camera_rays_.resize(count);
    generate_camera_rays(world, job, first, samples_, camera_rays_);
    found_.reset(count, job, counters.brightest.threshold());
    const SubpathJob subpaths{.mis = mis_context(world, job, settings),
                              .job = job,
                              .lengths = settings.lengths,
                              .samples = samples_,
                              .camera_rays = camera_rays_};
    light_.trace(subpaths, spared_rays(settings.lengths.roulette_depth).of_light, nullptr, found_, counters);
    for (const PathVertex& vertex : light_.vertices().all())
        if (vertex.merging.merges)
            photons.add(make_photon(vertex, vertex.geometric_normal), light_.vertices().words(), vertex.words);
    stamp(job.profile, Stage::Material);
}

void BdptWave::merge(const BdptJob& job) {
    const SharedPhotons& photons = *job.job.photons;
    const MisContext& mis = job.mis;
    for (std::uint32_t v = 0; v < eye_.vertices().all().size(); ++v) {
        const PathVertex& found = eye_.vertices().all()[v];
        // Without weights a path is to be found once.
        if (!found.merging.merges || (!job.settings.weighted && !found.is_seen_directly)) continue;
        const PathVertex& eye = eye_.vertices().whole(v);
        const MergeKernel kernel = merge_kernel(mis.merging, eye, eye.geometric_normal, eye.clearance);
        const double within = mis.merging.expected_within(kernel.radius);
        photons.map().for_each_in(kernel, [&](const Photon& photon) {
            if (!job.lengths.keeps(eye.next_edges - 1 + photon.edges)) return;
            const auto scattered = eye.evaluate_both_ways(photon.direction, TransportMode::Radiance);
            if (is_black(scattered.f_cos)) return;
            const double weight =
                job.settings.weighted ? 1.0 / (1.0 + others_of_merge(mis, eye, photon, scattered, within)) : 1.0;
            const Rgb light = merged_light(eye, photon, scattered, weight, within) *
                              job.wavelength_weight(eye.slot, eye.is_dispersed || photon.is_dispersed);
            shares_.clear();
            if (eye_.vertices().words().are_followed())
                eye_.vertices().words().join(eye_.vertices().words_after(eye, photon.direction), photons.words(),
                                             {photon.first_word, photon.word_count}, shares_);
            const bool is_direct = photon.edges == 1 && eye.is_seen_directly;
            found_.add(eye.slot, light, is_direct ? LightKind::Direct : LightKind::Indirect, shares_);
        });
    }
    stamp(job.job.profile, Stage::Mis);
}

void BdptWave::start(const World& world, const TileJob& job, const IntegratorSettings& settings) {
    const bool is_wanted = !settings.strategy || *settings.strategy == Strategy{.s = 0, .t = 2};
    PathLengths lengths = settings.lengths;
    if (settings.strategy && meets_lamps(settings)) {
        // By deltas alone there are no vertices in media.
        lengths.min_depth = std::max(lengths.min_depth, settings.strategy->edges());
        lengths.max_depth = std::min(lengths.max_depth, settings.strategy->edges());
    }
    lamps_.start(
        world, job, lengths, false,
        [&world, &job, &settings, is_wanted](const CameraSample& sample, const Ray& ray, const SurfacePoint& point) {
            const std::uint32_t light = world.lights().at(point);
            if (!is_wanted || light == kNone) return is_wanted ? 1.0f : 0.0f;
            const MisContext mis = mis_context(world, job, settings);
            const SubpathDensities arrived =
                arrive_from_lens(mis, {}, world.camera().connect(point.position, sample.lens, ray.time),
                                 static_cast<double>(abs_dot(ray.direction, point.geometric_normal)));
            return WeightRule{mis.raised, settings.weighted}.weight(
                sums_at_seen_emitter(mis, light, point.position, ray.time, arrived));
        });
}

}  // namespace etendue
