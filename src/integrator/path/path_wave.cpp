#include "integrator/path/path_wave.h"

#include "transport/dimensions.h"
#include "transport/roulette.h"
#include "transport/scattered_cone.h"
#include "wave/aov/first_hits.h"
#include "wave/ray_batch.h"

#include <algorithm>
#include <span>

namespace etendue {

PathWave::PathWave()
    : hits_(kCapacity), singles_(kBlock), samples_(kCapacity), camera_rays_(kCapacity), alpha_(kCapacity) {}

std::size_t PathWave::bytes() const {
    std::size_t bytes = sizeof *this + light_.bytes() + lamps_.bytes() + shadow_rays_.bytes() + lookups_.bytes() +
                        vector_bytes(hits_, interiors_, receivers_, passed_, panes_, ranges_, shares_, singles_,
                                     samples_, camera_rays_, alpha_);
    for (const NumberPairs* numbers :
         {&light_choice_, &light_triangle_, &light_direction_, &bsdf_direction_, &choices_, &medium_})
        bytes += numbers->bytes();
    return bytes;
}

void PathWave::trace(const World& world, const TileJob& job, const IntegratorSettings& settings, std::size_t first,
                     std::size_t count, TileBuffer& tile, RenderCounters& counters) {
    const std::span<Ray> camera_rays = std::span(camera_rays_).first(count);
    generate_camera_rays(world, job, first, std::span(samples_).first(count), camera_rays);
    if (world.traits().has_bodies) interiors_.assign(kCapacity, world.media().camera_interior());
    if (world.traits().chooses_lights_by_receiver) receivers_.resize(kCapacity);
    if (world.traits().has_panes) {
        passed_.assign(kCapacity, 0.0f);
        panes_.resize(kBlock);
    }
    words_.reset(job.aovs);
    if (words_.are_followed()) ranges_.assign(kCapacity, words_.begin_at_eye());
    light_.reset(count, job, counters.brightest.threshold());
    paths_.begin(camera_rays, samples_);
    if (world.traits().has_textures)
        for (std::size_t i = 0; i < count; ++i)
            paths_.set_cone(i, camera_cone(world, job.full_width, job.full_height, camera_rays[i]));
    std::fill_n(alpha_.begin(), count, 1.0f);
    active_ = count;
    stamp(job.profile, Stage::Generate);
    for (int depth = 1; active_ > 0; ++depth) {
        intersect_batch(world, job, depth == 1 ? RayKind::Primary : RayKind::Bounce, paths_.rays(active_),
                        std::span(hits_).first(active_), counters);
        if (depth == 1)
            hide_unseen_hits(world, camera_rays, std::span(hits_).first(count));
        else if (world.traits().clips_far)
            for (std::size_t i = 0; i < active_; ++i)
                if (path_history::is_seen(paths_.history[i]) && world.camera().is_too_far(paths_.ray(i), hits_[i]))
                    hits_[i] = {};
        if (light_.counts_rays())
            for (std::size_t i = 0; i < active_; ++i) light_.count_ray(paths_.slot[i]);
        if (depth == 1) {
            const std::span samples = std::span(samples_).first(count);
            const std::span hits = std::span(hits_).first(count);
            find_first_hits(world, job, samples, camera_rays, hits, tile);
            lamps_.note(samples, camera_rays, hits, counters);
        }
        stamp(job.profile, Stage::HitSetup);
        const auto trace_shadow_rays = [&] { shadow_rays_.resolve(world, job, samples_, light_, tile, counters); };
        shade({world, job, settings, depth}, trace_shadow_rays);
        trace_shadow_rays();
    }
    lamps_.note_radiance(std::span(samples_).first(count), light_);
    accumulate(job, std::span(samples_).first(count), light_, alpha_, tile, counters);
    stamp(job.profile, Stage::Film);
}

void PathWave::draw_numbers(const Context& context) {
    const std::span pixel_seeds(paths_.pixel_seed.data() + first_, count_);
    const std::span indices(paths_.index.data() + first_, count_);
    const bool has_bodies = context.world.traits().has_bodies;
    const bool ends =
        context.depth >= context.settings.lengths.max_depth && !has_bodies && !context.world.traits().has_panes;
    const auto draw = [&](std::uint32_t dimension, NumberPairs& numbers, bool is_needed = true) {
        if (is_needed && !ends)
            numbers.draw(context.job.sequence, pixel_seeds, indices, dimension);
        else
            numbers.draw_none(count_);
    };
    if (has_bodies) draw(body_dimension(context.depth, kMedium), medium_, context.world.traits().has_scattering_bodies);
    if (context.samples_lights() && context.world.traits().has_sampled_lights && !ends) draw_light_numbers(context, 0);
    draw(bounce_dimension(context.depth, kBsdfDirection), bsdf_direction_);
    draw(bounce_dimension(context.depth, kChoices), choices_);
}

SampleKey PathWave::light_sample_key(const Context& context, std::size_t k, std::uint32_t round) const {
    const std::size_t i = first_ + k;
    const SampleKey key = paths_.key(i);
    return etendue::light_sample_key(key, light_samples(context, i, path_history::kOnlyDelta), round);
}

void PathWave::draw_light_numbers(const Context& context, std::uint32_t round) {
    std::span pixel_seeds(paths_.pixel_seed.data() + first_, count_);
    std::span indices(paths_.index.data() + first_, count_);
    std::array<std::uint32_t, kBlock> split_seeds;
    std::array<std::uint32_t, kBlock> split_indices;
    if (context.settings.light_samples > 1) {
        for (std::size_t k = 0; k < count_; ++k) {
            const SampleKey key = light_sample_key(context, k, round);
            split_seeds[k] = key.pixel_seed;
            split_indices[k] = key.index;
        }
        pixel_seeds = std::span(split_seeds).first(count_);
        indices = std::span(split_indices).first(count_);
    }
    const auto draw = [&](BounceDimension which, NumberPairs& numbers) {
        numbers.draw(context.job.sequence, pixel_seeds, indices, bounce_dimension(context.depth, which));
    };
    if (context.world.traits().chooses_lights)
        draw(kLightChoice, light_choice_);
    else
        light_choice_.draw_none(count_);
    draw(kLightTriangle, light_triangle_);
    draw(kLightDirection, light_direction_);
}

template <typename TraceShadowRays>
void PathWave::shade(const Context& context, const TraceShadowRays& trace_shadow_rays) {
    std::size_t kept = 0;
    for (std::size_t first = 0; first < active_; first += kBlock) {
        shade_block(context, first, std::min(kBlock, active_ - first), kept);
        if (shadow_rays_.is_full()) trace_shadow_rays();
    }
    active_ = kept;
}

template <typename Stamp>
void PathWave::sample_direct_light(const Context& context, const LaneList& paths, std::uint32_t round,
                                   const Stamp& stamp) {
    sample_lights(context, paths, round);
    stamp(Stage::LightSampling);
    evaluate_and_sample_matte();
    evaluate_and_sample_glossy();
    for (const std::size_t k : paths)
        if (!block_[k].is_wide) evaluate_light(k);
    stamp(Stage::Material);
    queue_direct_light(context, paths, round);
    stamp(Stage::Mis);
}

template <typename Stamp>
void PathWave::sample_direct_light_in_rounds(const Context& context, const Stamp& stamp) {
    sample_direct_light(context, sampling_, 0, stamp);
    if (context.settings.light_samples <= 1) return;
    LaneList split;
    for (const std::size_t k : sampling_) split.add_if(paths_.is(path_history::kOnlyDelta, first_ + k), k);
    if (split.empty()) return;
    for (std::uint32_t round = 1; round < context.settings.light_samples; ++round) {
        draw_light_numbers(context, round);
        lanes_.forget_light();
        stamp(Stage::Numbers);
        sample_direct_light(context, split, round, stamp);
    }
}

void PathWave::shade_block(const Context& context, std::size_t first, std::size_t count, std::size_t& kept) {
    const World& world = context.world;
    WaveProfile* const profile = context.job.profile;
    const bool is_timed = profile != nullptr && profile->start_block();
    const auto stamp = [&](Stage stage) {
        if (is_timed) [[unlikely]]
            profile->stamp_in_block(stage);
    };
    first_ = first;
    count_ = count;
    draw_numbers(context);
    stamp(Stage::Numbers);
    world.geometry().fetch_triangles(std::span(hits_).subspan(first, count));
    lanes_.start();
    set_up(context);
    set_up_plain(context);
    stamp(Stage::HitSetup);
    // What leaves the scene was in no body, whatever holes in meshes made of its interior.
    add_environment(context);
    for (const std::size_t k : on_emitter_) add_emission(context, k);
    stamp(Stage::Emission);
    look_up_textures(context);
    make_scattering(context);
    stamp(Stage::Textures);
    sample_direct_light_in_rounds(context, stamp);
    lanes_.set_next_origins(count);
    for (const std::size_t k : on_surface_)
        if (!block_[k].is_wide) sample_bsdf(k);
    stamp(Stage::Material);
    if (!passed_.empty())
        for (const std::size_t k : on_surface_) passed_[first_ + k] = 0.0f;
    scatter_by_lanes(context);
    for (const std::size_t k : on_surface_)
        if (!block_[k].is_wide) lanes_.goes_on.set(k, scatter_at_surface(context, k) ? 1.0f : 0.0f);
    for (const std::size_t k : on_hidden_) pass_hidden(context, k);
    keep_survivors(context, kept);
    stamp(Stage::Roulette);
    if (profile != nullptr && !is_timed) profile->stamp_block();
}

void PathWave::keep_survivors(const Context& context, std::size_t& kept) {
    const World& world = context.world;
    const bool is_spared = context.depth < first_roulette(world, context.settings.lengths.roulette_depth);
    BlockSurvivors survivors(first_, kept);
    for (std::size_t l = 0; l < count_; l += Wide::kWidth) {
        const std::size_t i = first_ + l;
        const BasicRgb<Wide> throughput = paths_.throughput.load(i);
        const Wide survival =
            is_spared ? Wide(1.0f)
                      : eye_path_survival(max_component<Wide>(throughput) * paths_.eta_scale.load(i), context.depth);
        paths_.throughput.store(i, throughput * (Wide(1.0f) / survival));
        const WideMask goes_on = lanes_.goes_on.load(l) != Wide(0.0f);
        const WideMask survives = choices_.load(l).y < survival;
        survivors.add(goes_on && survives);
        if (context.job.profile == nullptr) continue;
        for (std::size_t lane = 0; lane < Wide::kWidth; ++lane)
            if (goes_on[lane] && !survives[lane]) end_path(context, l + lane, PathEnding::Roulette);
    }
    for (auto* column : {&paths_.origin.x, &paths_.origin.y, &paths_.origin.z, &paths_.direction.x, &paths_.direction.y,
                         &paths_.direction.z, &paths_.throughput.r, &paths_.throughput.g, &paths_.throughput.b,
                         &paths_.eta_scale, &paths_.pdf_solid_angle})
        survivors.move(*column);
    for (auto* column : {&paths_.slot, &paths_.pixel_seed, &paths_.index, &paths_.history}) survivors.move(*column);
    if (world.traits().has_motion) survivors.move(paths_.time);
    if (world.traits().has_transparency) survivors.move(paths_.alpha_key);
    if (world.traits().has_textures) {
        survivors.move(paths_.cone_width);
        survivors.move(paths_.cone_spread);
    }
    if (world.traits().has_bodies) {
        survivors.move(paths_.wavelength_nm);
        survivors.for_each([&](std::size_t from, std::size_t to) { interiors_[to] = interiors_[from]; });
    }
    if (!receivers_.empty())
        survivors.for_each([&](std::size_t from, std::size_t to) { receivers_[to] = receivers_[from]; });
    if (!passed_.empty()) survivors.for_each([&](std::size_t from, std::size_t to) { passed_[to] = passed_[from]; });
    if (words_.are_followed())
        survivors.for_each([&](std::size_t from, std::size_t to) { ranges_[to] = ranges_[from]; });
    kept = survivors.kept();
}

void PathWave::end_path(const Context& context, std::size_t k, PathEnding ending) const {
    WaveProfile* const profile = context.job.profile;
    if (profile == nullptr) return;
    const Vec2i pixel = pixel_position(context.job, samples_[paths_.slot[first_ + k]].pixel);
    profile->end_eye_path(ending, {pixel.x, pixel.y, paths_.index[first_ + k], context.depth});
}

std::uint32_t PathWave::alpha_key(const Context& context, std::size_t k) const {
    if (!context.world.traits().has_transparency) return 0;
    return sample_bits(paths_.key(first_ + k), bounce_dimension(context.depth, kAlpha));
}

}  // namespace etendue
