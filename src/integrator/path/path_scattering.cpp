#include "integrator/path/path_scattering.h"

#include "transport/bodies.h"
#include "transport/dispersion.h"
#include "transport/scattered_cone.h"

#include <array>

namespace etendue {

void PathScattering::evaluate_and_sample_by_lanes() {
    for (std::size_t l = 0; l < block_.count; l += Wide::kWidth)
        block_.lanes.u_bsdf.store(l, block_.bsdf_direction.load(l));
    block_.lanes.evaluate_diffuse<true>(block_.count);
    if (!block_.on_gloss.empty()) {
        for (std::size_t g = 0; g < block_.on_gloss.size(); ++g)
            glossy_.set_lobe(g, *block_.paths[block_.on_gloss[g]].glossy);
        glossy_.take(block_.lanes, block_.count, block_.choices, block_.bsdf_direction, false);
        glossy_.evaluate_and_sample(block_.on_gloss.size());
        glossy_.give(block_.lanes, block_.count, true);
    }
    block_.lanes.set_next_origins(block_.count);
}

void PathScattering::evaluate_by_lanes() {
    block_.lanes.evaluate_diffuse<false>(block_.count);
    if (block_.on_gloss.empty()) return;
    glossy_.take(block_.lanes, block_.count, block_.choices, block_.bsdf_direction, true);
    glossy_.evaluate(block_.on_gloss.size());
    glossy_.give(block_.lanes, block_.count, false);
}

void PathScattering::sample_bsdf(const PathContext& context, std::size_t k) {
    SingleShading& path = block_.singles[k];
    const float u_lobe = block_.choices[k].x;
    const Vec2f u = block_.bsdf_direction[k];
    path.sample = context.settings.even_directions ? path.scattering->sample_evenly(u_lobe, u)
                                                   : path.scattering->sample(u_lobe, u, TransportMode::Radiance);
}

void PathScattering::scatter_by_lanes(const PathContext& context) {
    const World& world = context.world;
    if (context.job.profile != nullptr)
        for (const std::size_t k : block_.on_surface)
            if (block_.paths[k].is_wide) count_sample(context, k, sample_of_lane(k));
    if (world.traits().has_textures) bend_cones(world);
    block_.lanes.scatter(block_.count, paths_, block_.first);
    if (!world.traits().has_transparency && !paths_.words.are_followed()) return;
    for (const std::size_t k : block_.on_surface) {
        if (!block_.paths[k].is_wide || block_.lanes.goes_on[k] == 0.0f) continue;
        paths_.alpha_key.set(block_.first + k, paths_.next_alpha_key(context, block_.first + k));
        if (paths_.words.are_followed())
            paths_.follow(block_.first + k,
                          block_.wide_event(context.world, paths_.words, k, block_.lanes.next_direction[k]));
    }
}

void PathScattering::count_sample(const PathContext& context, std::size_t k, const BsdfSample& sample) const {
    WaveProfile* const profile = context.job.profile;
    if (profile == nullptr) return;
    ++profile->use().bsdf_samples;
    if (is_black(sample.weight)) paths_.end_path(context, block_.first + k, PathEnding::Absorbed);
}

BsdfSample PathScattering::sample_of_lane(std::size_t k) const {
    BsdfSample sample;
    sample.weight = block_.lanes.next_weight[k];
    sample.pdf_solid_angle = block_.lanes.next_pdf[k];
    return sample;
}

void PathScattering::bend_cone(const World& world, std::size_t k, const RayCone& arriving,
                               const Vec3f& geometric_normal, const BsdfSample& sample) {
    const std::size_t i = block_.first + k;
    paths_.set_cone(i, scattered_cone(world, paths_.hits[i], geometric_normal, paths_.direction[i], arriving, sample));
}

void PathScattering::bend_cones(const World& world) {
    // All as if their lobes were wide; then once more those whose are not.
    LaneList narrow;
    std::array<RayCone, kBlockLanes> arriving;
    for (const std::size_t k : block_.on_surface) {
        if (!block_.paths[k].is_wide) continue;
        arriving[k] = paths_.arriving_cone(block_.first + k);
        paths_.set_cone(block_.first + k, scatter_cone(arriving[k], kMaxConeSpread));
        narrow.add_if(is_narrow_lobe(block_.lanes.next_pdf[k]), k);
    }
    for (const std::size_t k : narrow)
        bend_cone(world, k, arriving[k], block_.lanes.geometric_normal[k], sample_of_lane(k));
}

bool PathScattering::scatter_at_surface(const PathContext& context, std::size_t k) {
    const World& world = context.world;
    const std::size_t i = block_.first + k;
    const SingleShading& path = block_.singles[k];
    const SurfacePoint& point = path.point;
    const Scattering& scattering = *path.scattering;
    const BsdfSample& sample = path.sample;
    if (goes_straight_on(*point.material, sample) && !is_black(sample.weight)) {
        pass_straight(context, k);
        return true;
    }
    count_sample(context, k, sample);
    if (is_black(sample.weight)) return false;
    if (paths_.edges(i) >= context.settings.lengths.max_depth) {
        paths_.end_path(context, block_.first + k, PathEnding::TooLong);
        return false;
    }
    paths_.pdf_solid_angle.set(i, sample.pdf_solid_angle);
    paths_.history.set(i, sample.is_delta ? path_history::after_delta(paths_.history[i])
                                          : path_history::after_lobe(paths_.history[i], 1));
    if (world.traits().has_textures)
        bend_cone(world, k, paths_.arriving_cone(block_.first + k), point.geometric_normal, sample);
    if (paths_.words.are_followed())
        paths_.follow(block_.first + k, surface_event(scattering, sample.wi, sample.is_delta, TransportMode::Radiance,
                                                      paths_.words.label(world, point)));
    const Wavelength after = wavelength_after(
        scattering, path.crossing, sample, path.wavelength, path.chooses_wavelength,
        [&](const auto& share) { return world.spectral_response().mean_over_chance(path.wavelength, share); });
    paths_.throughput.set(i, paths_.throughput[i] * sample.weight * after.weight);
    paths_.wavelength_nm.set(i, after.nm);
    if (sample.is_transmission) paths_.roulette_scale.set(i, paths_.roulette_scale[i] * (sample.eta * sample.eta));
    paths_.origin.set(i, offset_origin(point.position, point.geometric_normal, point.clearance, sample.wi));
    paths_.direction.set(i, sample.wi);
    paths_.alpha_key.set(i, paths_.next_alpha_key(context, block_.first + k));
    if (path.crossing) paths_.interiors[i] = beyond(*path.crossing, point, sample.wi);
    return true;
}

bool PathScattering::scatter_in_medium(const PathContext& context, std::size_t k) {
    const std::size_t i = block_.first + k;
    const HomogeneousMedium* medium = context.world.media().within(paths_.interiors[i]);
    if (medium == nullptr) return false;
    const MediumSample sample = medium->sample(paths_.throughput[i], paths_.hits[i].t, block_.medium[k]);
    paths_.throughput.set(i, paths_.throughput[i] * sample.weight);
    if (!sample.scatters) return false;
    if (context.job.profile != nullptr) ++context.job.profile->use().phase_samples;

    const Vec3f wo = -paths_.direction[i];
    const Vec3f position = paths_.origin[i] - wo * sample.distance;
    const bool samples_lights = context.samples_lights() && context.world.traits().samples_lights_in_media;
    if (samples_lights && context.settings.lengths.is_long_enough(paths_.edges(i)))
        light_.queue_shadow_rays_in_medium(context, k, position, *medium);
    const Vec3f direction = medium->phase.sample(wo, block_.bsdf_direction[k]);
    const float pdf_solid_angle = medium->phase.pdf_solid_angle(wo, direction);
    paths_.origin.set(i, position);
    paths_.direction.set(i, direction);
    paths_.alpha_key.set(i, paths_.next_alpha_key(context, block_.first + k));
    paths_.pdf_solid_angle.set(i, pdf_solid_angle);
    if (!paths_.receivers.empty()) paths_.receivers[i] = position;
    if (!paths_.passed.empty()) paths_.passed[i] = 0.0f;
    const std::uint32_t history = path_history::after_lobe(paths_.history[i], 0);
    paths_.history.set(i, samples_lights ? history : history | path_history::kUnsampled);
    if (paths_.words.are_followed()) paths_.follow(block_.first + k, VertexEvent{});
    paths_.set_cone(i, scatter_cone(paths_.cone(i).at(sample.distance), lobe_spread(pdf_solid_angle)));
    return true;
}

void PathScattering::pass_straight(const PathContext& context, std::size_t k) {
    const std::size_t i = block_.first + k;
    const SingleShading& path = block_.singles[k];
    const SurfacePoint& point = path.point;
    paths_.throughput.set(i, paths_.throughput[i] * path.sample.weight);
    paths_.set_cone(i, paths_.cone(i).at(paths_.hits[i].t));
    paths_.origin.set(i, offset_origin(point.position, point.geometric_normal, point.clearance, paths_.direction[i]));
    paths_.alpha_key.set(i, paths_.next_alpha_key(context, block_.first + k));
    if (path.crossing) paths_.interiors[i] = beyond(*path.crossing, point, paths_.direction[i]);
    keep_last_vertex(k);
}

void PathScattering::keep_last_vertex(std::size_t k) {
    const std::size_t i = block_.first + k;
    if (!paths_.receivers.empty()) paths_.receivers[i] = block_.clear[k].from;
    paths_.passed[i] = block_.clear[k].passed;
}

void PathScattering::pass_hidden(const PathContext& context, std::size_t k) {
    const std::size_t i = block_.first + k;
    const SurfacePoint& point = block_.singles[k].point;
    const Vec3f direction = paths_.direction[i];
    // Light samples pass none but clear boundaries, so what the path meets beyond others could not have been sampled.
    if (point.material->is_clear)
        keep_last_vertex(k);
    else
        paths_.history.set(i, paths_.history[i] | path_history::kUnsampled);
    paths_.set_cone(i, paths_.cone(i).at(paths_.hits[i].t));
    paths_.origin.set(i, offset_origin(point.position, point.geometric_normal, point.clearance, direction));
    paths_.alpha_key.set(i, paths_.next_alpha_key(context, block_.first + k));
    paths_.interiors[i] = beyond(*block_.singles[k].crossing, point, direction);
}

}  // namespace etendue
