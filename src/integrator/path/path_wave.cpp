#include "integrator/path/path_wave.h"

#include "integrator/aov/first_hits.h"
#include "integrator/path/path_dimensions.h"
#include "integrator/ray_batch.h"
#include "integrator/scattered_cone.h"
#include "integrator/walk.h"

#include <algorithm>

namespace etendue {

PathWave::PathWave()
    : states_(kCapacity),
      rays_(kCapacity),
      hits_(kCapacity),
      singles_(kBlock),
      samples_(kCapacity),
      alpha_(kCapacity) {}

std::size_t PathWave::bytes() const {
    std::size_t bytes =
        sizeof *this + light_.bytes() + keys_.bytes() + shadow_rays_.bytes() + lookups_.bytes() +
        vector_bytes(states_, rays_, hits_, interiors_, receivers_, shares_, singles_, samples_, alpha_);
    for (const NumberPairs* numbers :
         {&light_choice_, &light_triangle_, &light_direction_, &bsdf_direction_, &choices_, &medium_})
        bytes += numbers->bytes();
    return bytes;
}

void PathWave::trace(const World& world, const TileJob& job, const PathOptions& options, std::size_t first,
                     std::size_t count, TileBuffer& tile, RenderCounters& counters) {
    generate_camera_rays(world, job, first, std::span(samples_).first(count), std::span(rays_).first(count));
    if (world.has_bodies()) interiors_.assign(kCapacity, world.camera_interior());
    if (world.chooses_lights_by_receiver()) receivers_.resize(kCapacity);
    words_.reset(job.aovs);
    light_.reset(count, job, counters.brightest.threshold());
    for (std::size_t i = 0; i < count; ++i) {
        states_[i] = PathState{};
        states_[i].slot = static_cast<std::uint32_t>(i);
        if (world.has_textures()) states_[i].cone = camera_cone(world, job, rays_[i]);
        if (words_.are_followed()) states_[i].words = words_.begin_at_eye();
        alpha_[i] = 1.0f;
    }
    active_ = count;
    stamp(job.profile, Stage::Generate);
    for (int depth = 1; active_ > 0; ++depth) {
        intersect_batch(world, job, depth == 1 ? RayKind::Primary : RayKind::Bounce, std::span(rays_).first(active_),
                        std::span(hits_).first(active_), counters);
        if (light_.counts_rays())
            for (std::size_t i = 0; i < active_; ++i) light_.count_ray(states_[i].slot);
        if (depth == 1)
            find_first_hits(world, job, std::span(samples_).first(count), std::span(rays_).first(count),
                            std::span(hits_).first(count), tile);
        stamp(job.profile, Stage::HitSetup);
        shade({world, job, options, depth});
        shadow_rays_.resolve(world, job, samples_, light_, tile, counters);
    }
    accumulate(job, std::span(samples_).first(count), light_, alpha_, tile, counters);
    stamp(job.profile, Stage::Film);
}

void PathWave::draw_numbers(const Context& context, std::size_t count) {
    keys_.clear();
    for (std::size_t k = 0; k < count; ++k) keys_.push_back(samples_[states_[first_ + k].slot].key);
    const bool has_bodies = context.world.has_bodies();
    const bool ends = context.depth >= context.options.lengths.max_depth && !has_bodies;
    const auto draw = [&](std::uint32_t dimension, NumberPairs& numbers, bool is_needed = true) {
        if (is_needed && !ends)
            numbers.draw(context.job.sequence, keys_, dimension);
        else
            numbers.draw_none(count);
    };
    if (has_bodies) draw(body_dimension(context.depth, kMedium), medium_, context.world.has_scattering_bodies());
    if (context.options.sample_lights && context.world.has_sampled_lights()) {
        draw(bounce_dimension(context.depth, kLightChoice), light_choice_, context.world.chooses_lights());
        draw(bounce_dimension(context.depth, kLightTriangle), light_triangle_);
        draw(bounce_dimension(context.depth, kLightDirection), light_direction_);
    }
    draw(bounce_dimension(context.depth, kBsdfDirection), bsdf_direction_);
    draw(bounce_dimension(context.depth, kChoices), choices_);
}

void PathWave::shade(const Context& context) {
    std::size_t kept = 0;
    for (std::size_t first = 0; first < active_; first += kBlock)
        shade_block(context, first, std::min(kBlock, active_ - first), kept);
    active_ = kept;
}

void PathWave::shade_block(const Context& context, std::size_t first, std::size_t count, std::size_t& kept) {
    const World& world = context.world;
    WaveProfile* const profile = context.job.profile;
    first_ = first;
    draw_numbers(context, count);
    stamp(profile, Stage::Numbers);
    surfaces_ = 0;
    world.fetch_triangles(std::span(hits_).subspan(first, count));
    for (std::size_t k = 0; k < count; ++k) {
        goes_on_[k] = false;
        if (set_up(context, k)) on_surface_[surfaces_++] = static_cast<std::uint8_t>(k);
    }
    set_up_plain(context);
    stamp(profile, Stage::HitSetup);
    for (std::size_t k = 0; k < count; ++k) {
        if (!hits_[first + k].valid())
            // What leaves the scene was in no body, whatever holes in meshes made of its interior.
            add_environment(context, k);
        else if (block_[k].emits)
            add_emission(context, k);
    }
    stamp(profile, Stage::Emission);
    const auto for_surfaces = [&](const auto& visit) {
        for (std::size_t lane = 0; lane < surfaces_; ++lane) visit(on_surface_[lane], lane);
    };
    look_up_textures(context);
    for_surfaces([&](std::size_t k, std::size_t lane) { make_scattering(context, k, lane); });
    stamp(profile, Stage::Textures);
    sample_lights(context);
    stamp(profile, Stage::LightSampling);
    evaluate_matte();
    evaluate_glossy();
    lanes_.set_next_origins(surfaces_);
    for_surfaces([&](std::size_t k, std::size_t) {
        if (!block_[k].is_wide) evaluate(k);
    });
    stamp(profile, Stage::Material);
    queue_direct_light(context);
    stamp(profile, Stage::Mis);
    for_surfaces([&](std::size_t k, std::size_t lane) {
        goes_on_[k] = block_[k].is_wide ? scatter_by_lanes(context, k, lane) : scatter_at_surface(context, k);
    });
    if (world.has_bodies())
        for (std::size_t k = 0; k < count; ++k)
            if (block_[k].is_at_hidden) pass_hidden(context, k);
    keep_survivors(context, count, kept);
    stamp(profile, Stage::Roulette);
}

void PathWave::keep_survivors(const Context& context, std::size_t count, std::size_t& kept) {
    // In bodies nothing but roulette bounds a walk: neither media nor hidden boundaries add edges.
    const int spared = context.world.has_bodies() ? std::min(context.options.lengths.roulette_depth, kLongPath)
                                                  : context.options.lengths.roulette_depth;
    const bool is_spared = context.depth < spared;
    Column survival;
    for (std::size_t k = 0; k < count; ++k) {
        const PathState& state = states_[first_ + k];
        survival.set(k, max_component(state.throughput) * state.eta_scale);
    }
    for (std::size_t k = 0; k < count; k += Wide::kWidth)
        survival.store(k, is_spared ? Wide(1.0f) : eye_path_survival(survival.load(k), context.depth));
    // Each is moved, whether or not it goes on: which do is so much by chance that a branch would take longer. Divided
    // is only what has been moved: what was just written would have to arrive before it could be moved.
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t i = first_ + k;
        const bool survives = choices_[k].y < survival[k];
        if (context.job.profile != nullptr && goes_on_[k] && !survives) end_path(context, k, PathEnding::Roulette);
        states_[kept] = states_[i];
        states_[kept].throughput *= 1.0f / survival[k];
        rays_[kept] = rays_[i];
        if (context.world.has_bodies()) interiors_[kept] = interiors_[i];
        if (!receivers_.empty()) receivers_[kept] = receivers_[i];
        kept += goes_on_[k] && survives ? 1 : 0;
    }
}

void PathWave::end_path(const Context& context, std::size_t k, PathEnding ending) const {
    WaveProfile* const profile = context.job.profile;
    if (profile == nullptr) return;
    const Vec2i pixel = pixel_position(context.job, samples_[states_[first_ + k].slot].pixel);
    profile->end_eye_path(ending, {pixel.x, pixel.y, keys_[k].index, context.depth});
}

std::uint32_t PathWave::alpha_key(const Context& context, std::size_t k) const {
    if (!context.world.has_transparency()) return 0;
    return sample_bits(keys_[k], bounce_dimension(context.depth, kAlpha));
}

}  // namespace etendue
