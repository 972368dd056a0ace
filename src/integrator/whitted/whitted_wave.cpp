#include "integrator/whitted/whitted_wave.h"

#include "transport/bodies.h"
#include "transport/connecting_ray.h"
#include "transport/direct_light.h"
#include "transport/dispersion.h"
#include "transport/roulette.h"
#include "transport/scattered_cone.h"
#include "wave/aov/first_hits.h"
#include "wave/ray_batch.h"
#include "world/scattering.h"

#include <algorithm>

namespace etendue {

namespace {

/// Returns how light that a branch meets comes to the eye.
LightKind kind_of(const WhittedBranch& branch) {
    return branch.edges == 1 ? LightKind::Seen : LightKind::Direct;
}

}  // namespace

std::size_t WhittedWave::bytes() const {
    return sizeof *this + vector_bytes(waiting_, batch_, rays_, hits_, samples_, alpha_) + keys_.bytes() +
           shadow_rays_.bytes() + light_choice_.bytes() + light_triangle_.bytes() + light_direction_.bytes() +
           environment_direction_.bytes() + found_.bytes() + lamps_.bytes();
}

void WhittedWave::trace(const World& world, const TileJob& job, const PathLengths& lengths, std::size_t first,
                        std::size_t count, TileBuffer& tile, RenderCounters& counters) {
    samples_.resize(count);
    rays_.resize(count);
    generate_camera_rays(world, job, first, samples_, rays_);
    found_.reset(count, job, counters.brightest.threshold());
    alpha_.assign(count, 1.0f);
    waiting_.assign(count, {});
    for (std::size_t i = 0; i < count; ++i) {
        WhittedBranch& branch = waiting_[i];
        branch.ray = rays_[i];
        branch.slot = static_cast<std::uint32_t>(i);
        branch.seed = samples_[i].key.pixel_seed;
        if (world.has_textures()) branch.cone = camera_cone(world, job.full_width, job.full_height, branch.ray);
        if (world.has_bodies()) branch.interior = world.camera_interior();
    }
    const Context context{world, job, lengths};
    while (!waiting_.empty()) trace_batch(context, tile, counters);
    lamps_.note_radiance(samples_, found_);
    accumulate(job, samples_, found_, alpha_, tile, counters);
}

void WhittedWave::trace_batch(const Context& context, TileBuffer& tile, RenderCounters& counters) {
    const std::size_t count = std::min(kCapacity, waiting_.size());
    const auto youngest = waiting_.end() - static_cast<std::ptrdiff_t>(count);
    batch_.assign(youngest, waiting_.end());
    waiting_.erase(youngest, waiting_.end());
    rays_.resize(count);
    hits_.resize(count);
    keys_.clear();
    bool are_camera_rays = true;
    for (std::size_t i = 0; i < count; ++i) {
        rays_[i] = batch_[i].ray;
        keys_.push_back({batch_[i].seed, samples_[batch_[i].slot].key.index});
        are_camera_rays = are_camera_rays && batch_[i].rays == 1;
        found_.count_ray(batch_[i].slot);
    }
    intersect_batch(context.world, context.job, are_camera_rays ? RayKind::Primary : RayKind::Bounce, rays_, hits_,
                    counters);
    // The first batch has all camera rays, in the order of their samples.
    if (are_camera_rays) {
        find_first_hits(context.world, context.job, samples_, rays_, hits_, tile);
        lamps_.note(samples_, rays_, hits_, counters);
    }
    light_choice_.draw(context.job.sequence, keys_, kBranchLightChoice);
    light_triangle_.draw(context.job.sequence, keys_, kBranchLightTriangle);
    light_direction_.draw(context.job.sequence, keys_, kBranchLightDirection);
    environment_direction_.draw(context.job.sequence, keys_, kBranchEnvironmentDirection);
    for (std::size_t i = 0; i < count; ++i) shade(context, i);
    shadow_rays_.resolve(context.world, context.job, samples_, found_, tile, counters);
}

void WhittedWave::shade(const Context& context, std::size_t i) {
    const World& world = context.world;
    const Hit& hit = hits_[i];
    WhittedBranch& branch = batch_[i];
    if (!hit.valid()) {
        add_environment(context, branch);
        return;
    }
    if (world.has_bodies()) {
        // What scatters on the way is lost like what is absorbed.
        branch.throughput *= transmittance(world, branch.interior, hit.t);
        if (is_black(branch.throughput)) return;
    }
    SurfacePoint point = world.surface_point(hit, branch.ray, branch.cone);
    std::optional<Crossing> crossing;
    if (world.has_bodies() && world.is_boundary(point))
        crossing = hit.in_contact ? world.contact_crossing(point, branch.interior, hit, branch.ray, branch.cone)
                                  : world.crossing(point, branch.interior);
    const bool is_wanted = branch.edges >= context.lengths.min_depth;
    if (point.material->emits && is_wanted && !(branch.rays == 1 && lamps_.finds(hit)))
        found_.add(branch.slot, branch.throughput * world.emission(point, -branch.ray.direction), kind_of(branch));
    if (crossing && crossing->is_hidden) {
        WhittedBranch next = grow(context, i, 0);
        next.ray.direction = branch.ray.direction;
        next.ray.origin = offset_origin(point.position, point.geometric_normal, point.clearance, next.ray.direction);
        next.cone = branch.cone.at(hit.t);
        next.interior = beyond(*crossing, point, next.ray.direction);
        push(next);
        return;
    }
    if (point.material->unlit) {
        if (is_wanted) found_.add(branch.slot, branch.throughput * world.unlit_color(point), kind_of(branch));
        return;
    }
    if (branch.edges < context.lengths.max_depth || point.material->is_pane) scatter(context, i, point, crossing);
}

void WhittedWave::scatter(const Context& context, std::size_t i, const SurfacePoint& point,
                          const std::optional<Crossing>& crossing) {
    const World& world = context.world;
    const WhittedBranch& branch = batch_[i];
    const Vec3f wo = -branch.ray.direction;
    // Where the index depends on the wavelength, a branch of all of them takes one to go on with.
    Wavelength wavelength{branch.wavelength_nm, Rgb(1.0f)};
    const bool chooses_wavelength = crossing && crossing->disperses() && branch.wavelength_nm == 0.0f;
    if (chooses_wavelength)
        wavelength = world.spectral_response().sample(sample_2d(context.job.sequence, keys_[i], kBranchWavelength).x);
    Bsdf storage;
    const Bsdf& bsdf = world.bsdf(point, wo, crossing ? crossing->relative_ior(wavelength.nm) : 0.0f, storage);
    const Scattering scattering(bsdf, point.shading, point.geometric_normal, wo);
    const bool ends_here = branch.edges >= context.lengths.max_depth;
    if (!ends_here && scattering.has_non_delta() && world.has_lights() && branch.edges + 1 >= context.lengths.min_depth)
        queue_direct_light(context, i, point, scattering, crossing, wavelength.weight);

    std::uint32_t child = 0;
    for (const BsdfSample& delta : scattering.deltas()) {
        // What goes straight through a pane has no vertex there.
        const bool passes = point.material->is_pane && delta.is_transmission;
        if (ends_here && !passes) continue;
        WhittedBranch next = grow(context, i, child++);
        if (chooses_wavelength && mirrors_all_wavelengths(scattering, delta)) {
            next.throughput *= world.spectral_response().mean(
                wavelength, [&](float nm) { return mirrored_share(scattering, crossing->relative_ior(nm)); });
        } else {
            next.throughput *= delta.weight * wavelength.weight;
            next.wavelength_nm = wavelength.nm;
        }
        if (delta.is_transmission) next.eta_scale *= delta.eta * delta.eta;
        if (world.has_textures())
            next.cone = scattered_cone(world, hits_[i], point.geometric_normal, branch.ray.direction,
                                       branch.cone.at(hits_[i].t), delta);
        next.edges = branch.edges + (passes ? 0 : 1);
        next.ray.origin = offset_origin(point.position, point.geometric_normal, point.clearance, delta.wi);
        next.ray.direction = delta.wi;
        if (crossing) next.interior = beyond(*crossing, point, delta.wi);
        push(next);
    }
}

WhittedBranch WhittedWave::grow(const Context& context, std::size_t i, std::uint32_t child) const {
    WhittedBranch next = batch_[i];
    next.seed = branch_seed(batch_[i].seed, child);
    ++next.rays;
    next.ray = {};
    next.ray.time = batch_[i].ray.time;
    if (context.world.has_transparency()) next.ray.alpha_key = sample_bits({next.seed, keys_[i].index}, kBranchAlpha);
    return next;
}

void WhittedWave::push(WhittedBranch branch) {
    const float chance = branch_survival(max_component(branch.throughput) * branch.eta_scale, branch.rays);
    if (chance < 1.0f) {
        const SampleKey key{branch.seed, samples_[branch.slot].key.index};
        if (to_unit_float(sample_bits(key, kBranchEnd)) >= chance) return;
        branch.throughput *= 1.0f / chance;
    }
    waiting_.push_back(branch);
}

void WhittedWave::queue_direct_light(const Context& context, std::size_t i, const SurfacePoint& point,
                                     const Scattering& scattering, const std::optional<Crossing>& crossing,
                                     const Rgb& factor) {
    const World& world = context.world;
    // No ray looks for the environment beside these two, of which the first knows nothing of its dimmer parts.
    if (world.has_sampled_lights()) {
        const ChosenLight chosen =
            world.sample_light(point.position, {light_choice_[i], light_triangle_[i], light_direction_[i]});
        const LightSample& light = chosen.sample;
        const bool is_environment = chosen.light == world.environment();
        if (!is_black(light.radiance))
            queue(context, i, point, scattering, crossing, light,
                  factor * light_sample_scale(
                               chosen, is_environment ? world.environment_emission_pdf_solid_angle(light.wi) : 0.0f));
    }
    if (!world.has_environment()) return;
    const LightSample light = world.sample_environment(point.position, environment_direction_[i]);
    if (is_black(light.radiance)) return;
    const float chosen_pdf = chosen_environment_pdf(world, point.position, light.wi);
    queue(context, i, point, scattering, crossing, light,
          factor * light_sample_scale({light, 1.0f, world.environment()}, chosen_pdf));
}

void WhittedWave::queue(const Context& context, std::size_t i, const SurfacePoint& point, const Scattering& scattering,
                        const std::optional<Crossing>& crossing, const LightSample& light, const Rgb& weight) {
    const World& world = context.world;
    const WhittedBranch& branch = batch_[i];
    const BsdfValue value = scattering.evaluate(light.wi, TransportMode::Radiance);
    Rgb contribution = branch.throughput * weight * value.f_cos * light.radiance;
    if (world.has_bodies())
        contribution *=
            transmittance(world, crossing ? beyond(*crossing, point, light.wi) : branch.interior, light.distance);
    if (is_black(contribution)) return;
    Ray ray = shadow_ray(offset_origin(point.position, point.geometric_normal, point.clearance, light.wi), light);
    ray.time = branch.ray.time;
    if (world.has_transparency())
        ray.alpha_key = ~sample_bits(keys_[i], kBranchAlpha);  // another key than those of branches
    shadow_rays_.to_sample(ray, branch.slot, contribution, LightKind::Direct, {});
}

void WhittedWave::add_environment(const Context& context, const WhittedBranch& branch) {
    const World& world = context.world;
    if (branch.edges == 1 && !(world.has_environment() && world.environment_visible_to_camera())) {
        alpha_[branch.slot] = 0.0f;
        return;
    }
    if (world.has_environment() && branch.edges >= context.lengths.min_depth)
        found_.add(branch.slot, branch.throughput * world.environment_radiance(branch.ray.direction), kind_of(branch));
}

}  // namespace etendue
