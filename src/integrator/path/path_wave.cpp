#include "integrator/path/path_wave.h"

#include "sampling/mis.h"
#include "world/scattering.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace etendue {

namespace {

/// Pairs of dimensions of one bounce.
enum BounceDimension : std::uint32_t {
    kLightChoice,
    kLightTriangle,
    kLightDirection,
    kBsdfDirection,
    kChoices,
    kAlpha,
    kBounceDimensions
};

std::uint32_t bounce_dimension(int depth, std::uint32_t which) {
    return kFirstFreeDimension + static_cast<std::uint32_t>(depth) * kBounceDimensions + which;
}

/// Most of the paths of `depth` edges that Russian roulette lets live. Lossless ones live on as long as paths usually
/// get; between perfect mirrors they would do so until the longest path allowed.
float most_survival(int depth) {
    constexpr int kLongPath = 64;
    return depth < kLongPath ? 1.0f : 0.95f;
}

/// From the surface to where the light was sampled, both ends clear of the surfaces there.
Ray shadow_ray(const SurfacePoint& point, const LightSample& light) {
    // What rounding may add to the length; the end is clear of the light by more than its own rounding.
    constexpr float kBeforeEnd = 1.0f - 8.0f * std::numeric_limits<float>::epsilon();
    Ray ray;
    ray.origin = offset_origin(point.position, point.geometric_normal, point.clearance, light.wi);
    ray.direction = light.wi;
    if (std::isinf(light.distance)) return ray;
    const Vec3f to_end = light.end - ray.origin;
    const float distance = length(to_end);
    if (distance > 0.0f) ray.direction = to_end * (1.0f / distance);
    ray.t_max = distance * kBeforeEnd;
    return ray;
}

}  // namespace

PathWave::PathWave()
    : states_(kCapacity),
      rays_(kCapacity),
      hits_(kCapacity),
      pixel_seeds_(kCapacity),
      sample_indices_(kCapacity),
      shadow_rays_(kCapacity),
      pending_(kCapacity),
      occluded_(kCapacity),
      samples_(kCapacity),
      radiance_(kCapacity),
      alpha_(kCapacity) {
    for (Numbers* numbers : {&light_choice_, &light_triangle_, &light_direction_, &bsdf_direction_, &choices_}) {
        numbers->x.resize(kCapacity);
        numbers->y.resize(kCapacity);
    }
}

void PathWave::trace(const World& world, const TileJob& job, const PathOptions& options, std::size_t first,
                     std::size_t count, TileBuffer& tile, RenderCounters& counters) {
    generate_camera_rays(world, job, first, std::span(samples_).first(count), std::span(rays_).first(count));
    for (std::size_t i = 0; i < count; ++i) {
        states_[i] = PathState{};
        states_[i].slot = static_cast<std::uint32_t>(i);
        pixel_seeds_[i] = samples_[i].key.pixel_seed;
        sample_indices_[i] = samples_[i].key.index;
        radiance_[i] = Rgb();
        alpha_[i] = 1.0f;
    }
    active_ = count;
    for (int depth = 1; active_ > 0; ++depth) {
        const Coherence coherence = depth == 1 ? Coherence::Coherent : Coherence::Incoherent;
        world.intersect(std::span(rays_).first(active_), std::span(hits_).first(active_), coherence);
        (depth == 1 ? counters.camera_rays : counters.bounce_rays) += active_;
        const Context context{world, job, options, depth};
        draw_numbers(context);
        shade(context);
        add_unoccluded(world, counters);
    }
    for (std::size_t i = 0; i < count; ++i) accumulate(job, samples_[i], radiance_[i], alpha_[i], tile, counters);
}

void PathWave::draw(const Context& context, std::uint32_t which, Numbers& numbers) {
    sample_2d(context.job.sequence, std::span(pixel_seeds_).first(active_), std::span(sample_indices_).first(active_),
              bounce_dimension(context.depth, which), std::span(numbers.x).first(active_),
              std::span(numbers.y).first(active_));
}

void PathWave::draw_numbers(const Context& context) {
    if (context.depth >= context.options.lengths.max_depth) return;
    if (context.options.sample_lights) {
        draw(context, kLightChoice, light_choice_);
        draw(context, kLightTriangle, light_triangle_);
        draw(context, kLightDirection, light_direction_);
    }
    draw(context, kBsdfDirection, bsdf_direction_);
    draw(context, kChoices, choices_);
}

void PathWave::shade(const Context& context) {
    pending_count_ = 0;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < active_; ++i) {
        PathState next;
        Ray next_ray;
        if (!shade_path(context, i, next, next_ray)) continue;
        states_[kept] = next;
        rays_[kept] = next_ray;
        pixel_seeds_[kept] = pixel_seeds_[i];
        sample_indices_[kept] = sample_indices_[i];
        ++kept;
    }
    active_ = kept;
}

bool PathWave::shade_path(const Context& context, std::size_t i, PathState& next, Ray& next_ray) {
    const PathState& state = states_[i];
    const Ray& ray = rays_[i];
    const Hit& hit = hits_[i];
    if (!hit.valid()) {
        add_environment(context, state, ray);
        return false;
    }
    const SurfacePoint point = context.world.surface_point(hit);
    if (point.material->emits) add_emission(context, state, ray, hit, point);
    if (point.material->unlit) {
        // Only what the eye sees directly or in mirrors shows an unlit surface; it lights nothing.
        if (state.only_delta && context.depth >= context.options.lengths.min_depth)
            radiance_[state.slot] += state.throughput * context.world.unlit_color(point);
        return false;
    }
    if (context.depth >= context.options.lengths.max_depth) return false;

    Bsdf storage;
    const Scattering scattering(context.world.bsdf(point, storage), point.shading, point.geometric_normal,
                                -ray.direction);
    if (context.options.sample_lights && scattering.has_non_delta() && context.world.has_lights() &&
        context.depth + 1 >= context.options.lengths.min_depth)
        queue_direct_light(context, i, point, scattering);

    const BsdfSample sample = scattering.sample(choices_.x[i], bsdf_direction_.pair(i), TransportMode::Radiance);
    if (is_black(sample.weight)) return false;

    next = state;
    next.throughput *= sample.weight;
    next.pdf_solid_angle = sample.pdf_solid_angle;
    next.after_delta = sample.is_delta;
    next.only_delta = state.only_delta && sample.is_delta;
    if (sample.is_transmission) next.eta_scale *= sample.eta * sample.eta;
    if (context.depth >= context.options.lengths.roulette_depth) {
        const float survival = std::min(most_survival(context.depth), max_component(next.throughput) * next.eta_scale);
        if (choices_.y[i] >= survival) return false;
        next.throughput *= 1.0f / survival;
    }
    next_ray.origin = offset_origin(point.position, point.geometric_normal, point.clearance, sample.wi);
    next_ray.direction = sample.wi;
    next_ray.alpha_key = alpha_key(context, i);
    return true;
}

void PathWave::add_environment(const Context& context, const PathState& state, const Ray& ray) {
    const World& world = context.world;
    if (context.depth == 1 && !(world.has_environment() && world.environment_visible_to_camera())) {
        alpha_[state.slot] = 0.0f;
        return;
    }
    if (!world.has_environment() || context.depth < context.options.lengths.min_depth) return;
    float weight = 1.0f;
    if (context.options.sample_lights && !state.after_delta)
        weight = power_heuristic(state.pdf_solid_angle, world.environment_pdf_solid_angle(ray.direction));
    radiance_[state.slot] += state.throughput * world.environment_radiance(ray.direction) * weight;
}

void PathWave::add_emission(const Context& context, const PathState& state, const Ray& ray, const Hit& hit,
                            const SurfacePoint& point) {
    if (context.depth < context.options.lengths.min_depth) return;
    const Rgb emitted = context.world.emission(point, -ray.direction);
    if (is_black(emitted)) return;
    float weight = 1.0f;
    if (context.options.sample_lights && !state.after_delta)
        weight =
            power_heuristic(state.pdf_solid_angle, context.world.emitter_pdf_solid_angle(point, ray.direction, hit.t));
    radiance_[state.slot] += state.throughput * emitted * weight;
}

std::uint32_t PathWave::alpha_key(const Context& context, std::size_t i) const {
    if (!context.world.has_transparency()) return 0;
    return sample_bits({pixel_seeds_[i], sample_indices_[i]}, bounce_dimension(context.depth, kAlpha));
}

void PathWave::queue_direct_light(const Context& context, std::size_t i, const SurfacePoint& point,
                                  const Scattering& scattering) {
    const PathState& state = states_[i];
    const ChosenLight chosen = context.world.sample_light(
        point.position, {light_choice_.pair(i), light_triangle_.pair(i), light_direction_.pair(i)});
    const LightSample& light = chosen.sample;
    if (is_black(light.radiance)) return;
    const BsdfValue value = scattering.evaluate(light.wi, TransportMode::Radiance);
    if (is_black(value.f_cos)) return;

    // A delta light can be found in no other way; its density is the choice's probability alone.
    const float scale = light.is_delta
                            ? 1.0f / chosen.probability
                            : power_heuristic(light.pdf_solid_angle, value.pdf_solid_angle) / light.pdf_solid_angle;
    Ray& ray = shadow_rays_[pending_count_];
    ray = shadow_ray(point, light);
    ray.alpha_key = ~alpha_key(context, i);  // another key than the bounce ray's
    pending_[pending_count_] = {state.throughput * value.f_cos * light.radiance * scale, state.slot};
    ++pending_count_;
}

void PathWave::add_unoccluded(const World& world, RenderCounters& counters) {
    if (pending_count_ == 0) return;
    world.occluded(std::span(shadow_rays_).first(pending_count_), std::span(occluded_).first(pending_count_));
    counters.shadow_rays += pending_count_;
    for (std::size_t i = 0; i < pending_count_; ++i)
        if (occluded_[i] == 0) radiance_[pending_[i].slot] += pending_[i].contribution;
}

}  // namespace etendue
