#include "integrator/bdpt/bdpt_wave.h"

#include "transport/roulette.h"
#include "wave/aov/first_hits.h"
#include "wave/profile/wave_profile.h"

#include <algorithm>
#include <cmath>

namespace etendue {

namespace {

/// Appends to `path` the vertices of the subpath that ends in `last`, the last one first.
void append_subpath(SubpathWave& wave, const PathVertex* last, std::vector<const PathVertex*>& path) {
    for (const PathVertex* v = last; v != nullptr;
         v = v->previous != PathVertex::kNoVertex ? &wave.whole(v->previous) : nullptr)
        path.push_back(v);
}

/// Returns how light that a subpath from the eye meets comes to the eye.
LightKind kind_of_light_met_by(const SubpathState& state) {
    if (state.index == kDirectlySeen) return LightKind::Seen;
    return state.lights_directly ? LightKind::Direct : LightKind::Indirect;
}

}  // namespace

std::size_t BdptWave::bytes() const {
    return sizeof *this +
           vector_bytes(samples_, camera_rays_, alpha_, shares_, own_, own_begin_, cache_, to_lights_, to_cameras_,
                        between_, receivers_, choosing_, choices_, lit_, wide_to_lights_, wide_to_cameras_) +
           found_.bytes() + lamps_.bytes() + eye_.bytes() + light_.bytes() + lamps_to_camera_.bytes() +
           to_light_.bytes() + to_camera_.bytes() + light_connections_.bytes() + wide_light_connections_.bytes() +
           camera_connections_.bytes() + wide_camera_connections_.bytes() + vertex_connections_.bytes() +
           wide_vertex_connections_.bytes();
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
    const Context context{
        {world, job, settings.lengths, Raised{settings.heuristic}, samples_, camera_rays_, job.merging}, settings};
    const SparedRays spared = spared_rays(settings.lengths.roulette_depth);
    context_ = &context;
    tile_ = &tile;
    counters_ = &counters;
    eye_.trace(context, spared.of_eye, this, found_, counters);
    context_ = nullptr;
    tile_ = nullptr;
    counters_ = nullptr;
    if (world.traits().has_lights) {
        light_.trace(context, spared.of_light, nullptr, found_, counters);
        if (context.wants(1) && context.wants({.s = 1, .t = 1}))
            lamps_to_camera_.connect(context, light_, camera_connections_,
                                     [&](const Emission& emission, const CameraConnection& camera, float cosine) {
                                         return weight(settings,
                                                       sums_of_seen_light(context.mis(), emission, camera, cosine));
                                     });
        find_candidates(context);
        stamp(job.profile, Stage::Mis);
        to_light_.collect(context, SubpathEnd::AtEye, eye_);
        stamp(job.profile, Stage::Numbers);
        const auto resolve_if_full = [&](Connections& connections) {
            if (connections.is_full()) connections.resolve(world, job, samples_, found_, tile, counters);
        };
        for (std::size_t begin = 0; begin < to_light_.size(); begin += kBlock) {
            const std::size_t end = std::min(begin + kBlock, to_light_.size());
            if (world.traits().has_sampled_lights) connect_to_lights(context, begin, end);
            resolve_if_full(light_connections_);
            resolve_if_full(wide_light_connections_);
            connect_to_vertices(context, begin, end);
            resolve_if_full(vertex_connections_);
            resolve_if_full(wide_vertex_connections_);
        }
        to_camera_.collect(context, SubpathEnd::AtLight, light_);
        stamp(job.profile, Stage::Numbers);
        for (std::size_t begin = 0; begin < to_camera_.size(); begin += kBlock) {
            connect_to_camera(context, begin, std::min(begin + kBlock, to_camera_.size()));
            resolve_if_full(camera_connections_);
            resolve_if_full(wide_camera_connections_);
        }
        if (job.photons != nullptr && context.wants(kMerges)) merge(context);
        for (Connections* connections : {&light_connections_, &wide_light_connections_, &vertex_connections_,
                                         &wide_vertex_connections_, &camera_connections_, &wide_camera_connections_})
            connections->resolve(world, job, samples_, found_, tile, counters);
    }
    lamps_.note_radiance(samples_, found_);
    accumulate(job, samples_, found_, alpha_, tile, counters);
    stamp(job.profile, Stage::Film);
}

void BdptWave::trace_photons(const World& world, const TileJob& job, const IntegratorSettings& settings,
                             std::size_t first, std::size_t count, PhotonList& photons, RenderCounters& counters) {
    samples_.resize(count);
    camera_rays_.resize(count);
    generate_camera_rays(world, job, first, samples_, camera_rays_);
    found_.reset(count, job, counters.brightest.threshold());
    const SubpathJob subpaths{world,    job,          settings.lengths, Raised{settings.heuristic},
                              samples_, camera_rays_, job.merging};
    light_.trace(subpaths, spared_rays(settings.lengths.roulette_depth).of_light, nullptr, found_, counters);
    for (const PathVertex& vertex : light_.vertices())
        if (vertex.merges) photons.add(make_photon(vertex, vertex.geometric_normal), light_.words(), vertex.words);
    stamp(job.profile, Stage::Material);
}

void BdptWave::merge(const Context& context) {
    const SharedPhotons& photons = *context.job.photons;
    const MisContext mis = context.mis();
    for (std::uint32_t v = 0; v < eye_.vertices().size(); ++v) {
        if (!eye_.vertices()[v].merges) continue;
        const PathVertex& eye = eye_.whole(v);
        const MergeKernel kernel{eye.position, eye.geometric_normal, mis.merging.radius(eye.position), eye.clearance};
        photons.map().for_each_in(kernel, [&](const Photon& photon) {
            if (!context.wants(eye.next_edges - 1 + photon.edges)) return;
            const auto scattered = eye.evaluate_both_ways(photon.direction, TransportMode::Radiance);
            if (is_black(scattered.f_cos)) return;
            const Rgb light = merged_light(mis, eye, eye.throughput, photon, scattered, context.settings.weighted) *
                              context.wavelength_weight(eye.slot, eye.is_dispersed || photon.is_dispersed);
            shares_.clear();
            if (eye_.words().are_followed())
                eye_.words().join(eye_.words_after(eye, photon.direction), photons.words(),
                                  {photon.first_word, photon.word_count}, shares_);
            found_.add(eye.slot, light, LightKind::Indirect, shares_);
        });
    }
    stamp(context.job.profile, Stage::Mis);
}

void BdptWave::start(const World& world, const TileJob& job, const IntegratorSettings& settings,
                     WeightObserver* observer) {
    observer_ = observer;
    const bool is_wanted = !settings.strategy || *settings.strategy == Strategy{.s = 0, .t = 2};
    lamps_.start(
        world, job, settings.lengths, false,
        [&world, &job, &settings, is_wanted](const CameraSample& sample, const Ray& ray, const SurfacePoint& point) {
            const std::uint32_t light = world.lights().at(point);
            if (!is_wanted || light == kNone) return is_wanted ? 1.0f : 0.0f;
            const SubpathJob of_sample{world, job, settings.lengths, Raised{settings.heuristic}, {}, {}};
            const SubpathDensities arrived =
                arrive_from_lens(of_sample.mis(), {}, world.camera().connect(point.position, sample.lens, ray.time),
                                 static_cast<double>(abs_dot(ray.direction, point.geometric_normal)));
            return weight(settings, sums_at_seen_emitter(of_sample.mis(), light, arrived));
        });
}

void BdptWave::show(const SubpathJob& job, std::size_t s, float weight, const PathLightEnd& end,
                    const PathVertex* light, const PathVertex* eye, const CameraConnection& camera) {
    std::vector<const PathVertex*> path;
    append_subpath(light_, light, path);
    std::reverse(path.begin(), path.end());
    append_subpath(eye_, eye, path);
    observer_->on_weight(job, {end, path, s, camera}, static_cast<double>(weight));
}

PathLightEnd BdptWave::light_end(std::uint32_t slot) const {
    const Emission& emission = light_.emissions()[slot];
    return {.light = emission.light,
            .triangle = emission.sample.triangle,
            .position = emission.sample.position,
            .direction = emission.sample.direction,
            .cos_light = emission.sample.cos_theta};
}

CameraConnection BdptWave::camera_of(const SubpathJob& job, const PathVertex& eye) const {
    const PathVertex* first = &eye;
    while (first->previous != PathVertex::kNoVertex) first = &eye_.vertices()[first->previous];
    return job.world.camera().connect(first->position, job.samples[eye.slot].lens, job.camera_rays[eye.slot].time);
}

void BdptWave::on_first_hits(std::span<const Ray> rays, std::span<const Hit> hits) {
    find_first_hits(context_->world, context_->job, samples_, rays, hits, *tile_);
    lamps_.note(samples_, rays, hits, *counters_);
}

void BdptWave::add(const SubpathState& state, const Rgb& light, const StrategySums& sums, const PathLightEnd& end,
                   const AovSet::Source& source) {
    const Context& context = *context_;
    if (context.job.profile != nullptr && state.index > kDirectlySeen) ++context.job.profile->use().bsdf_met_light;
    if (!context.wants({.s = 0, .t = state.index + 1})) return;
    const float share = weight(context.settings, sums);
    shares_.clear();
    if (eye_.words().are_followed()) eye_.words().end_at_light(state.words, source, shares_);
    found_.add(state.slot, state.throughput * light * context.wavelength_weight(state.slot, state.is_dispersed) * share,
               kind_of_light_met_by(state), shares_);
    if (observer_ != nullptr && state.index > kDirectlySeen) {
        const PathVertex& last = eye_.whole(state.last_vertex);
        show(context, 0, share, end, nullptr, &last, camera_of(context, last));
    }
}

void BdptWave::on_emitter(const SubpathState& state, const SurfacePoint& point, const Vec3f& direction,
                          const SubpathDensities& arrived) {
    if (state.edges < context_->lengths.min_depth) return;
    const World& world = context_->world;
    const Rgb emitted = world.materials().emission(point, -direction);
    if (is_black(emitted)) return;
    StrategySums sums;
    const std::uint32_t light = world.lights().at(point);
    const float cos_light = -dot(direction, point.geometric_normal);
    if (state.index > kDirectlySeen && light != kNone)
        sums = sums_at_emitter(context_->mis(), state.from, light, point.triangle, direction, cos_light, arrived);
    else if (state.is_direct && light != kNone)
        sums = sums_at_seen_emitter(context_->mis(), light, arrived);
    add(state, emitted, sums,
        {.light = light,
         .triangle = point.triangle,
         .position = point.position,
         .direction = -direction,
         .cos_light = cos_light,
         .is_reached_directly = state.is_direct},
        eye_.words().surface_source(point));
}

void BdptWave::on_unlit(const SubpathState& state, const SurfacePoint& point, const Vec3f& direction) {
    // Only what the eye sees directly or in mirrors shows an unlit surface; it lights nothing.
    if (state.only_delta && state.edges >= context_->lengths.min_depth)
        add(state, context_->world.materials().unlit_color(point), {},
            {.position = point.position, .direction = -direction}, eye_.words().surface_source(point));
}

void BdptWave::on_escape(const SubpathState& state, const Vec3f& direction) {
    const World& world = context_->world;
    const bool is_direct = state.index == kDirectlySeen;
    if (is_direct && !(world.traits().has_environment && world.traits().environment_visible_to_camera)) {
        alpha_[state.slot] = 0.0f;
        return;
    }
    if (!world.traits().has_environment || state.edges < context_->lengths.min_depth) return;
    StrategySums sums;
    if (!is_direct) sums = sums_at_environment(context_->mis(), state.from, direction, state.departing);
    add(state, world.environment().radiance(direction), sums,
        {.light = world.environment().light(), .direction = -direction, .is_reached_directly = state.is_direct},
        eye_.words().environment_source());
}

}  // namespace etendue
