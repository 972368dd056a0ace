#include "integrator/path/path_wave.h"

#include "integrator/aov/first_hits.h"
#include "integrator/path/path_dimensions.h"
#include "integrator/ray_batch.h"
#include "integrator/scattered_cone.h"
#include "integrator/walk.h"

#include <algorithm>

namespace etendue {

PathWave::PathWave()
    : states_(kCapacity), rays_(kCapacity), hits_(kCapacity), block_(kBlock), samples_(kCapacity), alpha_(kCapacity) {}

std::size_t PathWave::bytes() const {
    std::size_t bytes = sizeof *this + light_.bytes() + keys_.bytes() + shadow_rays_.bytes() + lookups_.bytes() +
                        vector_bytes(states_, rays_, hits_, interiors_, receivers_, shares_, block_, samples_, alpha_);
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
        const Context context{world, job, options, depth};
        draw_numbers(context);
        stamp(job.profile, Stage::Numbers);
        shade(context);
        shadow_rays_.resolve(world, job, samples_, light_, tile, counters);
    }
    accumulate(job, std::span(samples_).first(count), light_, alpha_, tile, counters);
    stamp(job.profile, Stage::Film);
}

void PathWave::draw_numbers(const Context& context) {
    keys_.clear();
    for (std::size_t i = 0; i < active_; ++i) keys_.push_back(samples_[states_[i].slot].key);
    const bool has_bodies = context.world.has_bodies();
    if (context.depth >= context.options.lengths.max_depth && !has_bodies) return;
    const auto draw = [&](std::uint32_t dimension, NumberPairs& numbers, bool is_needed = true) {
        if (is_needed)
            numbers.draw(context.job.sequence, keys_, dimension);
        else
            numbers.draw_none(active_);
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
    surfaces_ = 0;
    world.fetch_triangles(std::span(hits_).subspan(first, count));
    for (std::size_t k = 0; k < count; ++k) {
        goes_on_[k] = false;
        if (set_up(context, first, k)) on_surface_[surfaces_++] = static_cast<std::uint8_t>(k);
    }
    set_up_plain(context, first);
    stamp(profile, Stage::HitSetup);
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t i = first + k;
        if (!hits_[i].valid())
            // What leaves the scene was in no body, whatever holes in meshes made of its interior.
            add_environment(context, i);
        else if (const SurfacePoint& point = block_[k].point; point.material != nullptr && point.material->emits)
            add_emission(context, i, point);
    }
    stamp(profile, Stage::Emission);
    const auto for_surfaces = [&](const auto& visit) {
        for (std::size_t lane = 0; lane < surfaces_; ++lane)
            visit(first + on_surface_[lane], lane, block_[on_surface_[lane]]);
    };
    look_up_textures(context, first);
    for_surfaces([&](std::size_t i, std::size_t lane, ShadedPath& path) { make_scattering(context, i, lane, path); });
    stamp(profile, Stage::Textures);
    sample_lights(context, first);
    stamp(profile, Stage::LightSampling);
    evaluate_matte(first);
    evaluate_glossy(first);
    lanes_.set_next_origins(surfaces_);
    for_surfaces([&](std::size_t i, std::size_t, ShadedPath& path) {
        if (!path.is_wide) evaluate(i, path);
    });
    stamp(profile, Stage::Material);
    lanes_.weigh_light(surfaces_);
    for_surfaces([&](std::size_t i, std::size_t lane, const ShadedPath& path) {
        if (!path.samples_light) return;
        if (path.is_wide)
            queue_by_lanes(context, i, lane, path);
        else
            queue_direct_light(context, i, path);
    });
    stamp(profile, Stage::Mis);
    for_surfaces([&](std::size_t i, std::size_t lane, const ShadedPath& path) {
        goes_on_[i - first] =
            path.is_wide ? scatter_by_lanes(context, i, lane, path) : scatter_at_surface(context, i, path);
    });
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t i = first + k;
        if (block_[k].is_at_hidden) pass_hidden(context, i, block_[k].point, *block_[k].crossing);
        if (!goes_on_[k] || !survives(context, i)) continue;
        if (kept != i) {
            states_[kept] = states_[i];
            rays_[kept] = rays_[i];
            if (world.has_bodies()) interiors_[kept] = interiors_[i];
            if (!receivers_.empty()) receivers_[kept] = receivers_[i];
        }
        ++kept;
    }
    stamp(profile, Stage::Roulette);
}

bool PathWave::survives(const Context& context, std::size_t i) {
    // In bodies nothing but roulette bounds a walk: neither media nor hidden boundaries add edges.
    const int first = context.world.has_bodies() ? std::min(context.options.lengths.roulette_depth, kLongPath)
                                                 : context.options.lengths.roulette_depth;
    if (context.depth < first) return true;
    PathState& state = states_[i];
    const float survival = eye_path_survival(max_component(state.throughput) * state.eta_scale, context.depth);
    if (choices_[i].y >= survival) {
        end_path(context, i, PathEnding::Roulette);
        return false;
    }
    state.throughput *= 1.0f / survival;
    return true;
}

void PathWave::end_path(const Context& context, std::size_t i, PathEnding ending) const {
    WaveProfile* const profile = context.job.profile;
    if (profile == nullptr) return;
    const Vec2i pixel = pixel_position(context.job, samples_[states_[i].slot].pixel);
    profile->end_eye_path(ending, {pixel.x, pixel.y, keys_[i].index, context.depth});
}

std::uint32_t PathWave::alpha_key(const Context& context, std::size_t i) const {
    if (!context.world.has_transparency()) return 0;
    return sample_bits(keys_[i], bounce_dimension(context.depth, kAlpha));
}

}  // namespace etendue
