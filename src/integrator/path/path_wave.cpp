#include "integrator/path/path_wave.h"

#include "integrator/aov/first_hits.h"
#include "integrator/connecting_ray.h"
#include "integrator/ray_batch.h"
#include "integrator/scattered_cone.h"
#include "integrator/walk.h"
#include "sampling/mis.h"

#include <algorithm>
#include <cmath>

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

/// Those that only scenes with bodies need, apart from the others, so that they do not change what these are.
enum BodyDimension : std::uint32_t { kMedium, kWavelength, kBodyDimensions };

std::uint32_t bounce_dimension(int depth, std::uint32_t which) {
    return kFirstFreeDimension + static_cast<std::uint32_t>(depth) * kBounceDimensions + which;
}

std::uint32_t body_dimension(int depth, std::uint32_t which) {
    constexpr std::uint32_t kFirst = 1u << 30;
    return kFirst + static_cast<std::uint32_t>(depth) * kBodyDimensions + which;
}

/// Weight of a light sample that the scattering at hand would have found with `pdf_solid_angle`.
float light_sample_scale(const ChosenLight& chosen, float pdf_solid_angle) {
    const LightSample& light = chosen.sample;
    // A delta light can be found in no other way; its density is the choice's probability alone.
    return light.is_delta ? 1.0f / chosen.probability
                          : power_heuristic(light.pdf_solid_angle, pdf_solid_angle) / light.pdf_solid_angle;
}

/// Of light that a path meets.
LightKind kind_of_met_light(const PathState& state) {
    if (state.edges == 1 && state.only_delta) return LightKind::Seen;
    return state.is_direct ? LightKind::Direct : LightKind::Indirect;
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
      block_(kBlock),
      samples_(kCapacity),
      alpha_(kCapacity) {
    for (Numbers* numbers :
         {&light_choice_, &light_triangle_, &light_direction_, &bsdf_direction_, &choices_, &medium_}) {
        numbers->x.resize(kCapacity);
        numbers->y.resize(kCapacity);
    }
}

std::size_t PathWave::bytes() const {
    std::size_t bytes = sizeof *this + light_.bytes() +
                        vector_bytes(states_, rays_, hits_, interiors_, pixel_seeds_, sample_indices_, shadow_rays_,
                                     pending_, shares_, occluded_, block_, samples_, alpha_);
    for (const Numbers* numbers :
         {&light_choice_, &light_triangle_, &light_direction_, &bsdf_direction_, &choices_, &medium_})
        bytes += numbers->bytes();
    return bytes;
}

void PathWave::trace(const World& world, const TileJob& job, const PathOptions& options, std::size_t first,
                     std::size_t count, TileBuffer& tile, RenderCounters& counters) {
    generate_camera_rays(world, job, first, std::span(samples_).first(count), std::span(rays_).first(count));
    if (world.has_bodies()) interiors_.assign(kCapacity, world.camera_interior());
    words_.reset(job.aovs);
    light_.reset(count, job, counters.brightest.threshold());
    for (std::size_t i = 0; i < count; ++i) {
        states_[i] = PathState{};
        states_[i].slot = static_cast<std::uint32_t>(i);
        if (world.has_textures()) states_[i].cone = camera_cone(world, job, rays_[i]);
        pixel_seeds_[i] = samples_[i].key.pixel_seed;
        sample_indices_[i] = samples_[i].key.index;
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
        add_unoccluded(world, job, counters);
    }
    accumulate(job, std::span(samples_).first(count), light_, alpha_, tile, counters);
    stamp(job.profile, Stage::Film);
}

void PathWave::draw(const Context& context, std::uint32_t dimension, Numbers& numbers) {
    sample_2d(context.job.sequence, std::span(pixel_seeds_).first(active_), std::span(sample_indices_).first(active_),
              dimension, std::span(numbers.x).first(active_), std::span(numbers.y).first(active_));
}

void PathWave::draw_numbers(const Context& context) {
    const bool has_bodies = context.world.has_bodies();
    if (context.depth >= context.options.lengths.max_depth && !has_bodies) return;
    if (has_bodies) draw(context, body_dimension(context.depth, kMedium), medium_);
    if (context.options.sample_lights) {
        draw(context, bounce_dimension(context.depth, kLightChoice), light_choice_);
        draw(context, bounce_dimension(context.depth, kLightTriangle), light_triangle_);
        draw(context, bounce_dimension(context.depth, kLightDirection), light_direction_);
    }
    draw(context, bounce_dimension(context.depth, kBsdfDirection), bsdf_direction_);
    draw(context, bounce_dimension(context.depth, kChoices), choices_);
}

void PathWave::shade(const Context& context) {
    pending_count_ = 0;
    shares_.clear();
    std::size_t kept = 0;
    for (std::size_t first = 0; first < active_; first += kBlock)
        shade_block(context, first, std::min(kBlock, active_ - first), kept);
    active_ = kept;
}

void PathWave::shade_block(const Context& context, std::size_t first, std::size_t count, std::size_t& kept) {
    const World& world = context.world;
    WaveProfile* const profile = context.job.profile;
    std::array<std::uint8_t, kBlock> on_surface;
    std::size_t surfaces = 0;
    for (std::size_t k = 0; k < count; ++k) {
        goes_on_[k] = false;
        if (set_up(context, first, k)) on_surface[surfaces++] = static_cast<std::uint8_t>(k);
    }
    stamp(profile, Stage::HitSetup);
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t i = first + k;
        if (!hits_[i].valid())
            // What leaves the scene was in no body, whatever holes in meshes made of its interior.
            add_environment(context, states_[i], rays_[i]);
        else if (const SurfacePoint& point = block_[k].point; point.material != nullptr && point.material->emits)
            add_emission(context, states_[i], rays_[i], hits_[i], point);
    }
    stamp(profile, Stage::Emission);
    const auto for_surfaces = [&](const auto& visit) {
        for (std::size_t s = 0; s < surfaces; ++s) visit(first + on_surface[s], block_[on_surface[s]]);
    };
    for_surfaces([&](std::size_t i, ShadedPath& path) { make_scattering(context, i, path); });
    stamp(profile, Stage::Textures);
    for_surfaces([&](std::size_t i, ShadedPath& path) {
        if (path.samples_light) path.light = sample_light(context, i, path.point.position);
    });
    stamp(profile, Stage::LightSampling);
    for_surfaces([&](std::size_t i, ShadedPath& path) { evaluate(i, path); });
    stamp(profile, Stage::Material);
    for_surfaces([&](std::size_t i, const ShadedPath& path) {
        if (path.samples_light) queue_direct_light(context, i, path);
    });
    stamp(profile, Stage::Mis);
    for (std::size_t s = 0; s < surfaces; ++s) {
        const std::size_t k = on_surface[s];
        goes_on_[k] = scatter_at_surface(context, first + k, block_[k], next_[k]);
    }
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t i = first + k;
        if (!goes_on_[k] || !survives(context, i, next_[k].state)) continue;
        const PathStep& next = next_[k];
        const float time = rays_[i].time;
        states_[kept] = next.state;
        rays_[kept] = next.ray;
        rays_[kept].time = time;
        if (world.has_bodies()) interiors_[kept] = next.interior;
        pixel_seeds_[kept] = pixel_seeds_[i];
        sample_indices_[kept] = sample_indices_[i];
        ++kept;
    }
    stamp(profile, Stage::Roulette);
}

bool PathWave::set_up(const Context& context, std::size_t first, std::size_t k) {
    const World& world = context.world;
    const std::size_t i = first + k;
    const Hit& hit = hits_[i];
    ShadedPath& path = block_[k];
    path.point.material = nullptr;
    if (!hit.valid()) {
        end_path(context, i, PathEnding::Escaped);
        return false;
    }
    if (world.has_bodies() && scatter_in_medium(context, i, next_[k])) {
        goes_on_[k] = true;
        return false;
    }
    const PathState& state = states_[i];
    path.point = world.surface_point(hit, rays_[i], state.cone);
    path.crossing.reset();
    if (world.has_bodies() && world.is_boundary(path.point)) {
        path.crossing = world.crossing(path.point, interiors_[i]);
        if (path.crossing->is_hidden) {
            pass_hidden(context, i, path.point, *path.crossing, next_[k]);
            goes_on_[k] = true;
            return false;
        }
    }
    if (path.point.material->unlit) {
        // Only what the eye sees directly or in mirrors shows an unlit surface; it lights nothing.
        if (state.only_delta && state.edges >= context.options.lengths.min_depth)
            add_light(state, world.unlit_color(path.point), words_.surface_source(path.point));
        end_path(context, i, PathEnding::Unlit);
        return false;
    }
    if (state.edges < context.options.lengths.max_depth) return true;
    end_path(context, i, PathEnding::TooLong);
    return false;
}

void PathWave::make_scattering(const Context& context, std::size_t i, ShadedPath& path) {
    const World& world = context.world;
    const PathState& state = states_[i];
    const Vec3f wo = -rays_[i].direction;
    // Where the index depends on the wavelength, a path of all of them takes one to go on with.
    path.wavelength = {state.wavelength_nm, Rgb(1.0f)};
    path.chooses_wavelength = path.crossing && path.crossing->disperses() && state.wavelength_nm == 0.0f;
    if (path.chooses_wavelength)
        path.wavelength =
            world.spectral_response().sample(sample_2d(context.job.sequence, {pixel_seeds_[i], sample_indices_[i]},
                                                       body_dimension(context.depth, kWavelength))
                                                 .x);
    const Bsdf& bsdf = world.bsdf(path.point, wo,
                                  path.crossing ? path.crossing->relative_ior(path.wavelength.nm) : 0.0f, path.storage);
    path.scattering.emplace(bsdf, path.point.shading, path.point.geometric_normal, wo);
    path.samples_light = context.options.sample_lights && path.scattering->has_non_delta() && world.has_lights() &&
                         state.edges + 1 >= context.options.lengths.min_depth;
}

void PathWave::evaluate(std::size_t i, ShadedPath& path) const {
    if (path.samples_light && !is_black(path.light.sample.radiance))
        path.towards_light = path.scattering->evaluate(path.light.sample.wi, TransportMode::Radiance);
    path.sample = path.scattering->sample(choices_.x[i], bsdf_direction_.pair(i), TransportMode::Radiance);
}

bool PathWave::scatter_at_surface(const Context& context, std::size_t i, const ShadedPath& path, PathStep& next) {
    const World& world = context.world;
    const PathState& state = states_[i];
    const SurfacePoint& point = path.point;
    const Scattering& scattering = *path.scattering;
    const BsdfSample& sample = path.sample;
    if (context.job.profile != nullptr) ++context.job.profile->use().bsdf_samples;
    if (is_black(sample.weight)) {
        if (context.job.profile != nullptr) ++context.job.profile->use().bsdf_absorbed;
        end_path(context, i, PathEnding::Absorbed);
        return false;
    }
    next.state = state;
    if (words_.are_followed())
        next.state.words = words_.scatter_from_eye(
            state.words,
            surface_event(scattering, sample.wi, sample.is_delta, TransportMode::Radiance, words_.label(world, point)));
    next.state.throughput *= sample.weight;
    const auto* mirror = path.chooses_wavelength && sample.is_delta && !sample.is_transmission
                             ? std::get_if<SmoothDielectric>(&scattering.bsdf())
                             : nullptr;
    if (mirror != nullptr && mirror->fresnel.is_bare()) {
        // All wavelengths go where a mirror sends them, each with its own share: the path need not choose.
        next.state.throughput *= world.spectral_response().mean_over_chance([&](float nm) {
            const float cos_o = scattering.wo_local().z;
            const float ior = path.crossing->relative_ior(nm);
            return mirror->fresnel(std::min(1.0f, std::abs(cos_o)), cos_o > 0.0f ? ior : 1.0f / ior, cos_o > 0.0f)
                .reflection_share;
        });
    } else {
        next.state.throughput *= path.wavelength.weight;
        next.state.wavelength_nm = path.wavelength.nm;
    }
    next.state.pdf_solid_angle = sample.pdf_solid_angle;
    next.state.from = point.position;
    next.state.after_delta = sample.is_delta;
    next.state.is_direct = state.only_delta;
    next.state.only_delta = state.only_delta && sample.is_delta;
    if (sample.is_transmission) next.state.eta_scale *= sample.eta * sample.eta;
    if (world.has_textures())
        next.state.cone = scattered_cone(world, point, rays_[i].direction, state.cone.at(hits_[i].t), sample);
    ++next.state.edges;
    next.ray.origin = offset_origin(point.position, point.geometric_normal, point.clearance, sample.wi);
    next.ray.direction = sample.wi;
    next.ray.alpha_key = alpha_key(context, i);
    if (world.has_bodies()) next.interior = path.crossing ? beyond(*path.crossing, point, sample.wi) : interiors_[i];
    return true;
}

bool PathWave::scatter_in_medium(const Context& context, std::size_t i, PathStep& next) {
    const HomogeneousMedium* medium = context.world.medium(interiors_[i]);
    if (medium == nullptr) return false;
    PathState& state = states_[i];
    const Ray& ray = rays_[i];
    const MediumSample sample = medium->sample(state.throughput, hits_[i].t, medium_.pair(i));
    state.throughput *= sample.weight;
    if (!sample.scatters) return false;

    const Vec3f position = ray.origin + ray.direction * sample.distance;
    const bool samples_lights = context.options.sample_lights && context.world.has_lights_in_media();
    if (samples_lights && state.edges >= context.options.lengths.min_depth)
        queue_direct_light_in_medium(context, i, position, *medium);
    next.state = state;
    next.ray.origin = position;
    next.ray.direction = medium->phase.sample(-ray.direction, bsdf_direction_.pair(i));
    next.ray.alpha_key = alpha_key(context, i);
    next.interior = interiors_[i];
    next.state.pdf_solid_angle = medium->phase.pdf_solid_angle(-ray.direction, next.ray.direction);
    next.state.from = position;
    next.state.after_delta = !samples_lights;
    next.state.is_direct = state.only_delta;
    next.state.only_delta = false;
    if (words_.are_followed()) next.state.words = words_.scatter_from_eye(state.words, VertexEvent{});
    next.state.cone = scatter_cone(state.cone.at(sample.distance), lobe_spread(next.state.pdf_solid_angle));
    return true;
}

void PathWave::pass_hidden(const Context& context, std::size_t i, const SurfacePoint& point, const Crossing& crossing,
                           PathStep& next) {
    next.state = states_[i];
    // No light sample passes a boundary, so what the path meets next could not have been sampled.
    next.state.after_delta = true;
    next.state.cone = next.state.cone.at(hits_[i].t);
    next.ray.direction = rays_[i].direction;
    next.ray.origin = offset_origin(point.position, point.geometric_normal, point.clearance, next.ray.direction);
    next.ray.alpha_key = alpha_key(context, i);
    next.interior = beyond(crossing, point, next.ray.direction);
}

bool PathWave::survives(const Context& context, std::size_t i, PathState& state) const {
    // In bodies nothing but roulette bounds a walk: neither media nor hidden boundaries add edges.
    const int first = context.world.has_bodies() ? std::min(context.options.lengths.roulette_depth, kLongPath)
                                                 : context.options.lengths.roulette_depth;
    if (context.depth < first) return true;
    const float survival = std::min(most_survival(context.depth), max_component(state.throughput) * state.eta_scale);
    if (choices_.y[i] >= survival) {
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
    profile->end_path(ending, {pixel.x, pixel.y, sample_indices_[i], context.depth});
}

void PathWave::add_environment(const Context& context, const PathState& state, const Ray& ray) {
    const World& world = context.world;
    if (context.depth == 1 && !(world.has_environment() && world.environment_visible_to_camera())) {
        alpha_[state.slot] = 0.0f;
        return;
    }
    if (!world.has_environment() || state.edges < context.options.lengths.min_depth) return;
    if (context.job.profile != nullptr && context.depth > 1) ++context.job.profile->use().bsdf_met_light;
    float weight = 1.0f;
    if (context.options.sample_lights && !state.after_delta)
        weight = power_heuristic(state.pdf_solid_angle, world.light_probability(state.from, world.environment()) *
                                                            world.environment_pdf_solid_angle(ray.direction));
    add_light(state, world.environment_radiance(ray.direction) * weight, words_.environment_source());
}

void PathWave::add_emission(const Context& context, const PathState& state, const Ray& ray, const Hit& hit,
                            const SurfacePoint& point) {
    if (state.edges < context.options.lengths.min_depth) return;
    const Rgb emitted = context.world.emission(point, -ray.direction);
    if (is_black(emitted)) return;
    if (context.job.profile != nullptr && context.depth > 1) ++context.job.profile->use().bsdf_met_light;
    float weight = 1.0f;
    if (context.options.sample_lights && !state.after_delta)
        weight = power_heuristic(state.pdf_solid_angle,
                                 context.world.emitter_pdf_solid_angle(state.from, point, ray.direction, hit.t));
    add_light(state, emitted * weight, words_.surface_source(point));
}

std::uint32_t PathWave::alpha_key(const Context& context, std::size_t i) const {
    if (!context.world.has_transparency()) return 0;
    return sample_bits({pixel_seeds_[i], sample_indices_[i]}, bounce_dimension(context.depth, kAlpha));
}

ChosenLight PathWave::sample_light(const Context& context, std::size_t i, const Vec3f& position) const {
    return context.world.sample_light(position,
                                      {light_choice_.pair(i), light_triangle_.pair(i), light_direction_.pair(i)});
}

void PathWave::queue_direct_light(const Context& context, std::size_t i, const ShadedPath& path) {
    if (context.job.profile != nullptr) ++context.job.profile->use().light_samples;
    const LightSample& light = path.light.sample;
    if (is_black(light.radiance) || is_black(path.towards_light.f_cos)) return;
    const SurfacePoint& point = path.point;
    Rgb contribution = states_[i].throughput * path.towards_light.f_cos * light.radiance *
                       light_sample_scale(path.light, path.towards_light.pdf_solid_angle);
    if (context.world.has_bodies())
        contribution *=
            path.wavelength.weight *
            transmittance(context.world, path.crossing ? beyond(*path.crossing, point, light.wi) : interiors_[i],
                          light.distance);
    queue(context, i,
          shadow_ray(offset_origin(point.position, point.geometric_normal, point.clearance, light.wi), light),
          contribution, path.light.light,
          words_.are_followed() ? surface_event(*path.scattering, light.wi, false, TransportMode::Radiance,
                                                words_.label(context.world, point))
                                : VertexEvent{});
}

void PathWave::queue_direct_light_in_medium(const Context& context, std::size_t i, const Vec3f& position,
                                            const HomogeneousMedium& medium) {
    if (context.job.profile != nullptr) ++context.job.profile->use().light_samples;
    const ChosenLight chosen = sample_light(context, i, position);
    const LightSample& light = chosen.sample;
    if (is_black(light.radiance)) return;
    const float phase = medium.phase.pdf_solid_angle(-rays_[i].direction, light.wi);
    queue(context, i, shadow_ray(position, light),
          states_[i].throughput * light.radiance * medium.transmittance(light.distance) *
              (phase * light_sample_scale(chosen, phase)),
          chosen.light, VertexEvent{});
}

void PathWave::add_light(const PathState& state, const Rgb& light, const AovSet::Source& source) {
    const LightKind kind = kind_of_met_light(state);
    if (!words_.are_followed()) return light_.add(state.slot, state.throughput * light, kind);
    // What is added at once stands behind what waits.
    const std::size_t kept = shares_.size();
    words_.end_at_light(state.words, source, shares_);
    light_.add(state.slot, state.throughput * light, kind, std::span(shares_).subspan(kept));
    shares_.resize(kept);
}

void PathWave::queue(const Context& context, std::size_t i, Ray ray, const Rgb& contribution, std::uint32_t light,
                     const VertexEvent& event) {
    if (is_black(contribution)) return;
    if (words_.are_followed())
        words_.end_at_light(states_[i].words, event, words_.light_source(context.world, light), shares_);
    ray.time = rays_[i].time;
    ray.alpha_key = ~alpha_key(context, i);  // another key than the bounce ray's
    shadow_rays_[pending_count_] = ray;
    pending_[pending_count_] = {contribution, states_[i].slot, static_cast<std::uint32_t>(shares_.size()),
                                states_[i].only_delta ? LightKind::Direct : LightKind::Indirect};
    ++pending_count_;
}

void PathWave::add_unoccluded(const World& world, const TileJob& job, RenderCounters& counters) {
    if (pending_count_ == 0) return;
    occluded_batch(world, job, RayKind::Shadow, std::span(shadow_rays_).first(pending_count_),
                   std::span(occluded_).first(pending_count_), counters);
    const std::span<const ExpressionShare> shares(shares_);
    for (std::size_t i = 0, first = 0; i < pending_count_; ++i) {
        const PendingLight& pending = pending_[i];
        light_.count_ray(pending.slot);
        if (occluded_[i] == 0)
            light_.add(pending.slot, pending.contribution, pending.kind,
                       shares.subspan(first, pending.end_of_shares - first));
        first = pending.end_of_shares;
    }
    stamp(job.profile, Stage::Splat);
}

}  // namespace etendue
