#include "integrator/light/light_wave.h"

#include "integrator/connecting_ray.h"
#include "integrator/walk.h"
#include "world/scattering.h"

#include <algorithm>
#include <cmath>

namespace etendue {

namespace {

/// Pairs of dimensions of a subpath's beginning, and then of each bounce; far from those of eye paths.
enum LightDimension : std::uint32_t { kLightChoice, kTriangle, kPosition, kDirection, kLightLens, kEmissionDimensions };
enum BounceDimension : std::uint32_t { kScattering, kChoices, kLens, kMedium, kWavelength, kAlpha, kBounceDimensions };

constexpr std::uint32_t kFirstLightDimension = 1u << 29;

std::uint32_t bounce_dimension(int depth, std::uint32_t which) {
    return kFirstLightDimension + kEmissionDimensions + static_cast<std::uint32_t>(depth) * kBounceDimensions + which;
}

}  // namespace

void LightWave::trace(const World& world, const TileJob& job, const IntegratorOptions& options, std::size_t first,
                      std::size_t count, TileBuffer& tile, RenderCounters& counters) {
    // Their keys and times; a light path is made for each.
    samples_.resize(count);
    rays_.resize(count);
    generate_camera_rays(world, job, first, samples_, rays_);
    // No path from the light tells what the camera sees through: the image is opaque.
    for (const CameraSample& sample : samples_) accumulate(job, sample, Rgb(), 1.0f, tile, counters);
    if (!world.has_lights()) return;
    emit({world, job, options, 0});
    add_unoccluded(world, tile, counters);
    for (int depth = 1; !paths_.empty(); ++depth) {
        rays_.clear();
        for (const LightPathState& path : paths_) rays_.push_back(path.ray);
        hits_.resize(rays_.size());
        world.intersect(rays_, hits_, Coherence::Incoherent);
        counters.bounce_rays += rays_.size();
        shade({world, job, options, depth});
        add_unoccluded(world, tile, counters);
    }
}

void LightWave::emit(const Context& context) {
    const World& world = context.world;
    paths_.clear();
    for (std::size_t i = 0; i < samples_.size(); ++i) {
        const SampleKey key = samples_[i].key;
        const auto pair = [&](std::uint32_t which) {
            return sample_2d(context.job.sequence, key, kFirstLightDimension + which);
        };
        const EmissionNumbers u{pair(kTriangle), pair(kPosition), pair(kDirection)};
        const Emission emission = world.sample_emission(pair(kLightChoice), u, rays_[i].time);
        LightPathState state;
        state.ray = emission.ray;
        state.ray.time = rays_[i].time;
        state.ray.alpha_key = sample_bits(key, kFirstLightDimension);
        state.key = key;
        if (world.has_bodies()) state.interior = world.light_interior(emission.light);
        if (context.options.min_depth <= 1) {
            state.throughput = Rgb(1.0f / (emission.sample.pdf_position_area * emission.probability));
            connect(
                context, state, emission.sample.position,
                [&](const Vec3f& direction) { return world.surface_emission(emission, direction); },
                [&](const Vec3f& direction) { return emission.sample.origin(direction); });
        }
        state.throughput = emission.weight;
        state.begun_with = max_component(emission.weight);
        if (context.options.max_depth > 1 && !is_black(emission.weight)) paths_.push_back(state);
    }
}

void LightWave::shade(const Context& context) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < paths_.size(); ++i) {
        LightPathState state = paths_[i];
        if (!shade_path(context, hits_[i], state)) continue;
        state.ray.alpha_key = sample_bits(state.key, bounce_dimension(context.depth, kAlpha));
        paths_[kept++] = state;
    }
    paths_.resize(kept);
}

bool LightWave::shade_path(const Context& context, const Hit& hit, LightPathState& state) {
    const World& world = context.world;
    if (!hit.valid()) return false;
    if (world.has_bodies() && scatter_in_medium(context, hit, state)) return survives(context, state);
    const SurfacePoint point = world.surface_point(hit);
    std::optional<Crossing> crossing;
    if (world.has_bodies() && world.is_boundary(point)) {
        crossing = world.crossing(point, state.interior);
        if (crossing->is_hidden) {
            state.interior = beyond(*crossing, point, state.ray.direction);
            state.ray.origin =
                offset_origin(point.position, point.geometric_normal, point.clearance, state.ray.direction);
            return survives(context, state);
        }
    }
    // The edge to the camera is one more.
    if (point.material->unlit || state.edges >= context.options.max_depth) return false;
    return scatter_at_surface(context, point, crossing, state) && survives(context, state);
}

bool LightWave::scatter_at_surface(const Context& context, const SurfacePoint& point,
                                   const std::optional<Crossing>& crossing, LightPathState& state) {
    const World& world = context.world;
    const auto pair = [&](std::uint32_t which) {
        return sample_2d(context.job.sequence, state.key, bounce_dimension(context.depth, which));
    };
    const Vec3f wo = -state.ray.direction;
    if (crossing && crossing->disperses() && state.wavelength_nm == 0.0f) {
        const Wavelength wavelength = world.spectral_response().sample(pair(kWavelength).x);
        state.wavelength_nm = wavelength.nm;
        state.throughput *= wavelength.weight;
    }
    Bsdf storage;
    const Bsdf& bsdf = world.bsdf(point, wo, crossing ? crossing->relative_ior(state.wavelength_nm) : 0.0f, storage);
    const Scattering scattering(bsdf, point.shading, point.geometric_normal, wo);
    const auto start = [&](const Vec3f& direction) {
        return offset_origin(point.position, point.geometric_normal, point.clearance, direction);
    };
    if (scattering.has_non_delta() && state.edges + 1 >= context.options.min_depth) {
        LightPathState here = state;
        connect(
            context, here, point.position,
            [&](const Vec3f& direction) {
                if (crossing) here.interior = beyond(*crossing, point, direction);
                return scattering.evaluate(direction, TransportMode::Importance).f_cos;
            },
            start);
    }
    if (state.edges + 2 > context.options.max_depth) return false;
    const BsdfSample sample = scattering.sample(pair(kChoices).x, pair(kScattering), TransportMode::Importance);
    if (is_black(sample.weight)) return false;
    state.throughput *= sample.weight;
    state.ray.origin = start(sample.wi);
    state.ray.direction = sample.wi;
    if (crossing) state.interior = beyond(*crossing, point, sample.wi);
    ++state.edges;
    return true;
}

bool LightWave::scatter_in_medium(const Context& context, const Hit& hit, LightPathState& state) {
    const HomogeneousMedium* medium = context.world.medium(state.interior);
    if (medium == nullptr) return false;
    const auto pair = [&](std::uint32_t which) {
        return sample_2d(context.job.sequence, state.key, bounce_dimension(context.depth, which));
    };
    const MediumSample sample = medium->sample(state.throughput, hit.t, pair(kMedium));
    state.throughput *= sample.weight;
    if (!sample.scatters) return false;
    const Vec3f position = state.ray.origin + state.ray.direction * sample.distance;
    const Vec3f wo = -state.ray.direction;
    if (state.edges >= context.options.min_depth)
        connect(
            context, state, position,
            [&](const Vec3f& direction) { return Rgb(medium->phase.pdf_solid_angle(wo, direction)); },
            [&](const Vec3f&) { return position; });
    state.ray.origin = position;
    state.ray.direction = medium->phase.sample(wo, pair(kScattering));
    return true;
}

bool LightWave::survives(const Context& context, LightPathState& state) const {
    const int first = context.world.has_bodies() ? std::min(context.options.roulette_depth, kLongPath)
                                                 : context.options.roulette_depth;
    if (context.depth < first) return true;
    const float survival = std::min(most_survival(context.depth), max_component(state.throughput) / state.begun_with);
    if (sample_2d(context.job.sequence, state.key, bounce_dimension(context.depth, kChoices)).y >= survival)
        return false;
    state.throughput *= 1.0f / survival;
    return true;
}

template <typename Reflected, typename Start>
void LightWave::connect(const Context& context, const LightPathState& state, const Vec3f& position,
                        const Reflected& reflected, const Start& start) {
    const TileJob& job = context.job;
    const Vec2f lens =
        sample_2d(job.sequence, state.key,
                  context.depth == 0 ? kFirstLightDimension + kLightLens : bounce_dimension(context.depth, kLens));
    const CameraConnection camera = context.world.connect_to_camera(position, lens, state.ray.time);
    if (!(camera.importance_area > 0.0f)) return;
    const Vec2f pixel{camera.film.x * static_cast<float>(job.full_width),
                      camera.film.y * static_cast<float>(job.full_height)};
    if (!reaches(job.window, *job.filter, pixel)) return;
    const Vec3f to_lens = camera.lens - position;
    const float distance = length(to_lens);
    const Vec3f direction = to_lens * (1.0f / distance);
    const Rgb arriving = reflected(direction);
    if (is_black(arriving)) return;
    const Rgb value =
        state.throughput * arriving * camera.importance_area * transmittance(context.world, state.interior, distance);
    if (is_black(value)) return;
    Ray ray = connecting_ray(start(direction), camera.lens);
    ray.time = state.ray.time;
    ray.alpha_key = ~sample_bits(state.key, bounce_dimension(context.depth, kAlpha));
    shadow_rays_.push_back(ray);
    pending_.push_back({{pixel, value}, state.key});
}

void LightWave::add_unoccluded(const World& world, TileBuffer& tile, RenderCounters& counters) {
    if (shadow_rays_.empty()) return;
    occluded_.resize(shadow_rays_.size());
    world.occluded(shadow_rays_, occluded_);
    counters.shadow_rays += shadow_rays_.size();
    for (std::size_t i = 0; i < pending_.size(); ++i) {
        if (occluded_[i] != 0) continue;
        const PendingSplat& pending = pending_[i];
        if (is_finite(pending.splat.value) && min_component(pending.splat.value) >= 0.0f)
            tile.splats().push_back(pending.splat);
        else
            counters.drop({static_cast<int>(pending.splat.position.x), static_cast<int>(pending.splat.position.y),
                           pending.key.index});
    }
    shadow_rays_.clear();
    pending_.clear();
}

}  // namespace etendue
