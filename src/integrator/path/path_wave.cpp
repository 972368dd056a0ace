#include "integrator/path/path_wave.h"

#include "core/vector_bytes.h"
#include "transport/roulette.h"
#include "wave/aov/first_hits.h"
#include "wave/camera_wave.h"
#include "wave/ray_batch.h"

#include <algorithm>
#include <span>

namespace etendue {

PathWave::PathWave() : camera_rays_(kCapacity) {}

std::size_t PathWave::bytes() const {
    return sizeof *this + paths_.bytes() + block_.bytes() + light_.bytes() + places_.bytes() +
           vector_bytes(camera_rays_);
}

void PathWave::trace(const World& world, const TileJob& job, const IntegratorSettings& settings, std::size_t first,
                     std::size_t count, TileBuffer& tile, RenderCounters& counters) {
    const std::span<Ray> camera_rays = std::span(camera_rays_).first(count);
    const std::span<CameraSample> samples = std::span(paths_.samples).first(count);
    generate_camera_rays(world, job, first, samples, camera_rays);
    if (world.traits().has_clear_surfaces) block_.clear.resize(kBlockLanes);
    light_.found.reset(count, job, counters.brightest.threshold());
    light_.alpha.assign(count, 1.0f);
    paths_.begin(world, job, camera_rays);
    active_ = count;
    stamp(job.profile, Stage::Generate);
    for (int rays = 1; active_ > 0; ++rays) {
        intersect_batch(world, job, rays == 1 ? RayKind::Primary : RayKind::Bounce, paths_.rays(active_),
                        std::span(paths_.hits).first(active_), counters);
        if (rays == 1)
            hide_unseen_hits(world, camera_rays, std::span(paths_.hits).first(count));
        else
            look_again(world, job, counters);
        if (light_.found.counts_rays())
            for (std::size_t i = 0; i < active_; ++i) light_.found.count_ray(paths_.slot[i]);
        if (rays == 1) {
            const std::span hits = std::span(paths_.hits).first(count);
            find_first_hits(world, job, samples, camera_rays, hits, tile);
            light_.lamps.note(samples, camera_rays, hits, counters);
        }
        stamp(job.profile, Stage::HitSetup);
        const auto trace_shadow_rays = [&] {
            light_.shadow_rays.resolve(world, job, samples, light_.found, tile, counters);
        };
        shade({world, job, settings, rays, counters}, trace_shadow_rays);
        trace_shadow_rays();
    }
    light_.lamps.note_radiance(samples, light_.found);
    accumulate(job, samples, light_.found, light_.alpha, tile, counters);
    stamp(job.profile, Stage::Film);
}

void PathWave::look_again(const World& world, const TileJob& job, RenderCounters& counters) {
    if (!world.traits().hides_surfaces && !world.traits().clips_far) return;
    const RayColumns rays = paths_.rays(active_);
    for (std::size_t i = 0; i < active_; ++i)
        if (path_history::is_seen(paths_.history[i]))
            paths_.hits[i] =
                hit_seen_by_camera(world, job, rays[i], paths_.hits[i], paths_.slot[i], light_.found, counters);
}

template <typename TraceShadowRays>
void PathWave::shade(const PathContext& context, const TraceShadowRays& trace_shadow_rays) {
    std::size_t kept = 0;
    for (std::size_t first = 0; first < active_; first += kBlockLanes) {
        shade_block(context, first, std::min(kBlockLanes, active_ - first), kept);
        if (light_.shadow_rays.is_full()) trace_shadow_rays();
    }
    active_ = kept;
}

template <typename Stamp>
void PathWave::queue_light_samples(const PathContext& context, const LaneList& paths, std::uint32_t round,
                                   const Stamp& stamp) {
    if (paths.empty()) return;
    for (const std::size_t k : paths)
        if (!block_.paths[k].is_wide) light_.evaluate(k);
    stamp(Stage::Material);
    light_.queue_shadow_rays(context, paths, round);
    stamp(Stage::Mis);
}

template <typename Stamp>
void PathWave::take_more_light_samples(const PathContext& context, const Stamp& stamp) {
    if (context.settings.light_samples <= 1) return;
    LaneList split;
    for (const std::size_t k : block_.sampling) split.add_if(paths_.is(path_history::kOnlyDeltas, block_.first + k), k);
    if (split.empty()) return;
    for (std::uint32_t round = 1; round < context.settings.light_samples; ++round) {
        block_.draw_light_numbers(context, paths_, round);
        block_.lanes.forget_light();
        stamp(Stage::Numbers);
        light_.sample(context, split, round);
        stamp(Stage::LightSampling);
        scattering_.evaluate_by_lanes();
        queue_light_samples(context, split, round, stamp);
    }
}

void PathWave::shade_block(const PathContext& context, std::size_t first, std::size_t count, std::size_t& kept) {
    const World& world = context.world;
    WaveProfile* const profile = context.job.profile;
    const bool is_timed = profile != nullptr && profile->clock().start_block();
    const auto stamp = [&](Stage stage) {
        if (is_timed) [[unlikely]]
            profile->clock().stamp_in_block(stage);
    };
    block_.first = first;
    block_.count = count;
    block_.draw_numbers(context, paths_);
    stamp(Stage::Numbers);
    world.geometry().fetch_triangles(std::span(paths_.hits).subspan(first, count));
    block_.lanes.start();
    places_.set_up(context);
    places_.set_up_plain(context);
    stamp(Stage::HitSetup);
    // What leaves the scene was in no body, whatever holes in meshes made of its interior.
    light_.add_environment(context);
    light_.add_suns(context);
    for (const std::size_t k : block_.on_emitter) light_.add_emission(context, k);
    stamp(Stage::Emission);
    places_.look_up_textures(context);
    places_.make_scattering(context);
    stamp(Stage::Textures);
    light_.sample(context, block_.sampling, 0);
    stamp(Stage::LightSampling);
    scattering_.evaluate_and_sample_by_lanes();
    for (const std::size_t k : block_.on_surface)
        if (!block_.paths[k].is_wide) scattering_.sample_bsdf(context, k);
    queue_light_samples(context, block_.sampling, 0, stamp);
    take_more_light_samples(context, stamp);
    if (!paths_.passed.empty())
        for (const std::size_t k : block_.on_surface) paths_.passed[block_.first + k] = 0.0f;
    scattering_.scatter_by_lanes(context);
    for (const std::size_t k : block_.on_surface)
        if (!block_.paths[k].is_wide)
            block_.lanes.goes_on.set(k, scattering_.scatter_at_surface(context, k) ? 1.0f : 0.0f);
    for (const std::size_t k : block_.on_hidden) scattering_.pass_hidden(context, k);
    keep_survivors(context, kept);
    stamp(Stage::Roulette);
    if (profile != nullptr && !is_timed) profile->clock().stamp_block();
}

void PathWave::keep_survivors(const PathContext& context, std::size_t& kept) {
    const World& world = context.world;
    const bool is_spared = context.rays < first_roulette(world, context.settings.lengths.roulette_depth);
    const float most = most_survival(PathKind::Walk, context.rays);
    BlockSurvivors survivors(block_.first, kept);
    for (std::size_t l = 0; l < block_.count; l += Wide::kWidth) {
        const std::size_t i = block_.first + l;
        const BasicRgb<Wide> throughput = paths_.throughput.load(i);
        const Wide survival =
            is_spared ? Wide(1.0f)
                      : eye_path_survival(max_component<Wide>(throughput) * paths_.roulette_scale.load(i), most);
        paths_.throughput.store(i, throughput * (Wide(1.0f) / survival));
        const WideMask goes_on = block_.lanes.goes_on.load(l) != Wide(0.0f);
        const WideMask survives = block_.choices.load(l).y < survival;
        survivors.add(goes_on && survives);
        if (context.job.profile == nullptr) continue;
        for (std::size_t lane = 0; lane < Wide::kWidth; ++lane)
            if (goes_on[lane] && !survives[lane])
                paths_.end_path(context, block_.first + l + lane, PathEnding::Roulette);
    }
    paths_.move(survivors, world.traits());
    kept = survivors.kept();
}

}  // namespace etendue
