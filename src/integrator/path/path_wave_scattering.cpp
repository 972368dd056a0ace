// Where paths are, and where surfaces and media send them.
#include "integrator/path/path_dimensions.h"
#include "integrator/path/path_wave.h"
#include "integrator/scattered_cone.h"
#include "integrator/walk.h"

#include <algorithm>
#include <cmath>

namespace etendue {

bool PathWave::set_up(const Context& context, std::size_t first, std::size_t k) {
    const World& world = context.world;
    const std::size_t i = first + k;
    const Hit& hit = hits_[i];
    ShadedPath& path = block_[k];
    path.point.material = nullptr;
    path.is_at_hidden = false;
    if (!hit.valid()) {
        end_path(context, i, PathEnding::Escaped);
        return false;
    }
    if (world.has_bodies() && scatter_in_medium(context, i)) {
        goes_on_[k] = true;
        return false;
    }
    const PathState& state = states_[i];
    path.plain = world.plain_surface(hit);
    if (path.plain != nullptr) {
        path.point.material = world.material(hit);
        if (world.has_textures()) {  // for scattered_cone
            path.point.instance = hit.instance;
            path.point.geometry = hit.geometry;
            path.point.triangle = hit.triangle;
        }
        path.crossing.reset();
        if (state.edges < context.options.lengths.max_depth) return true;
        end_path(context, i, PathEnding::TooLong);
        return false;
    }
    path.point = world.surface_point(hit, rays_[i], state.cone);
    path.crossing.reset();
    if (world.has_bodies() && world.is_boundary(path.point)) {
        path.crossing = world.crossing(path.point, interiors_[i]);
        if (path.crossing->is_hidden) {
            path.is_at_hidden = true;
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

void PathWave::set_up_plain(const Context& context, std::size_t first) {
    const World& world = context.world;
    bool any = false;
    any_textured_ = false;
    for (std::size_t lane = 0; lane < surfaces_; ++lane) {
        const std::size_t k = on_surface_[lane];
        const std::size_t i = first + k;
        lanes_.wo.set(lane, -rays_[i].direction);
        const PlainSurface* const plain = block_[k].plain;
        if (plain == nullptr) continue;
        any = true;
        const Hit& hit = hits_[i];
        lanes_.set_hit(lane, world.hit_triangle(hit), {hit.u, hit.v});
        if (plain->textured == nullptr) continue;
        any_textured_ = true;
        textured_.set_hit(lane, world.hit_coordinates(hit, *plain), std::abs(states_[i].cone.width_at(hit.t)));
    }
    if (any) lanes_.set_up_points(surfaces_);
    if (any_textured_) textured_.set_up(lanes_, surfaces_);
}

void PathWave::look_up_textures(const Context& context, std::size_t first) {
    if (!any_textured_) return;
    const World& world = context.world;
    const auto is_textured = [](const ShadedPath& path) {
        return path.plain != nullptr && path.plain->textured != nullptr;
    };
    lookups_.clear();
    for (std::size_t lane = 0; lane < surfaces_; ++lane)
        if (const ShadedPath& path = block_[on_surface_[lane]]; is_textured(path))
            world.add_lookups(*path.plain, textured_.uv[lane], textured_.footprint(lane), lookups_);
    lookups_.finish();
    for (std::size_t lane = 0; lane < surfaces_; ++lane) {
        ShadedPath& path = block_[on_surface_[lane]];
        if (!is_textured(path)) continue;
        const auto& lobe = path.storage.emplace<MetallicRoughness>(world.lobe(*path.plain, lookups_));
        path.glossy = &lobe;
        if (!lobe.is_plain()) set_up_singly(context, first + on_surface_[lane], path);
    }
}

void PathWave::set_up_singly(const Context& context, std::size_t i, ShadedPath& path) const {
    path.plain = nullptr;
    path.point = context.world.surface_point(hits_[i], rays_[i], states_[i].cone);
}

void PathWave::make_scattering(const Context& context, std::size_t i, std::size_t lane, ShadedPath& path) {
    const World& world = context.world;
    const PathState& state = states_[i];
    const Vec3f wo = -rays_[i].direction;
    path.samples_light = context.options.sample_lights && world.has_sampled_lights() &&
                         state.edges + 1 >= context.options.lengths.min_depth;
    lanes_.throughput.set(lane, state.throughput);
    path.is_wide = path.plain != nullptr;
    if (path.is_wide) {
        if (path.plain->textured == nullptr) path.glossy = path.plain->matte == nullptr ? &path.plain->glossy : nullptr;
        if (world.has_textures()) path.point.geometric_normal = lanes_.geometric_normal[lane];
        if (path.glossy == nullptr) return lanes_.albedo.set(lane, std::get_if<Diffuse>(path.plain->matte)->albedo);
        if (words_.are_followed()) {
            if (path.plain->textured == nullptr) path.storage = *path.glossy;
            path.scattering.emplace(path.storage,
                                    Frame{lanes_.tangent[lane], lanes_.bitangent[lane], lanes_.normal[lane]},
                                    lanes_.geometric_normal[lane], wo);
        }
        return;
    }
    path.glossy = nullptr;
    lanes_.position.set(lane, path.point.position);
    // Where the index depends on the wavelength, a path of all of them takes one to go on with.
    path.wavelength = {state.wavelength_nm, Rgb(1.0f)};
    path.chooses_wavelength = path.crossing && path.crossing->disperses() && state.wavelength_nm == 0.0f;
    if (path.chooses_wavelength)
        path.wavelength = world.spectral_response().sample(
            sample_2d(context.job.sequence, keys_[i], body_dimension(context.depth, kWavelength)).x);
    const Bsdf& bsdf = world.bsdf(path.point, wo,
                                  path.crossing ? path.crossing->relative_ior(path.wavelength.nm) : 0.0f, path.storage);
    const auto* diffuse = std::get_if<Diffuse>(&bsdf);
    if (const auto* lobe = std::get_if<MetallicRoughness>(&bsdf); lobe != nullptr && lobe->is_plain() && !path.crossing)
        path.glossy = lobe;
    path.is_wide = path.glossy != nullptr || (diffuse != nullptr && !path.crossing);
    if (path.is_wide) {
        const SurfacePoint& point = path.point;
        lanes_.geometric_normal.set(lane, point.geometric_normal);
        lanes_.clearance.set(lane, point.clearance);
        lanes_.tangent.set(lane, point.shading.tangent);
        lanes_.bitangent.set(lane, point.shading.bitangent);
        lanes_.normal.set(lane, point.shading.normal);
        if (diffuse != nullptr) return lanes_.albedo.set(lane, diffuse->albedo);
        if (!words_.are_followed()) return;
    }
    path.scattering.emplace(bsdf, path.point.shading, path.point.geometric_normal, wo);
    path.samples_light = path.samples_light && path.scattering->has_non_delta();
}

void PathWave::evaluate_matte(std::size_t first) {
    for (std::size_t lane = 0; lane < surfaces_; ++lane) lanes_.u.set(lane, bsdf_direction_[first + on_surface_[lane]]);
    lanes_.evaluate_matte(surfaces_);
}

void PathWave::evaluate_glossy(std::size_t first) {
    std::array<std::uint8_t, kBlock> lane_of{};
    std::size_t count = 0;
    for (std::size_t lane = 0; lane < surfaces_; ++lane) {
        const ShadedPath& path = block_[on_surface_[lane]];
        if (path.glossy == nullptr) continue;
        const std::size_t i = first + on_surface_[lane];
        glossy_.set_lobe(count, *path.glossy);
        glossy_.tangent.set(count, lanes_.tangent[lane]);
        glossy_.bitangent.set(count, lanes_.bitangent[lane]);
        glossy_.normal.set(count, lanes_.normal[lane]);
        glossy_.geometric_normal.set(count, lanes_.geometric_normal[lane]);
        glossy_.wo.set(count, lanes_.wo[lane]);
        glossy_.light_wi.set(count, lanes_.light_wi[lane]);
        glossy_.u_lobe.set(count, choices_[i].x);
        glossy_.u.set(count, bsdf_direction_[i]);
        lane_of[count++] = static_cast<std::uint8_t>(lane);
    }
    glossy_.evaluate(count);
    for (std::size_t g = 0; g < count; ++g) {
        const std::size_t lane = lane_of[g];
        lanes_.f_cos.set(lane, glossy_.f_cos[g]);
        lanes_.pdf.set(lane, glossy_.pdf[g]);
        lanes_.next_direction.set(lane, glossy_.next_direction[g]);
        lanes_.next_weight.set(lane, glossy_.next_weight[g]);
        lanes_.next_pdf.set(lane, glossy_.next_pdf[g]);
    }
}

void PathWave::evaluate(std::size_t i, ShadedPath& path) const {
    if (path.samples_light && !is_black(path.light.sample.radiance))
        path.towards_light = path.scattering->evaluate(path.light.sample.wi, TransportMode::Radiance);
    path.sample = path.scattering->sample(choices_[i].x, bsdf_direction_[i], TransportMode::Radiance);
}

bool PathWave::scatter(const Context& context, std::size_t i, const SurfacePoint& point, const BsdfSample& sample) {
    WaveProfile* const profile = context.job.profile;
    if (profile != nullptr) ++profile->use().bsdf_samples;
    if (is_black(sample.weight)) {
        if (profile != nullptr) ++profile->use().bsdf_absorbed;
        end_path(context, i, PathEnding::Absorbed);
        return false;
    }
    PathState& state = states_[i];
    state.throughput *= sample.weight;
    state.pdf_solid_angle = sample.pdf_solid_angle;
    state.after_delta = sample.is_delta;
    state.is_direct = state.only_delta;
    state.only_delta = state.only_delta && sample.is_delta;
    ++state.edges;
    if (context.world.has_textures())
        state.cone = scattered_cone(context.world, point, rays_[i].direction, state.cone.at(hits_[i].t), sample);
    rays_[i].direction = sample.wi;
    rays_[i].alpha_key = alpha_key(context, i);
    return true;
}

VertexEvent PathWave::wide_event(const Context& context, const ShadedPath& path, const Vec3f& wi) const {
    const auto label = words_.label(context.world, path.point);
    return path.glossy == nullptr ? matte_event(label)
                                  : surface_event(*path.scattering, wi, false, TransportMode::Radiance, label);
}

bool PathWave::scatter_by_lanes(const Context& context, std::size_t i, std::size_t lane, const ShadedPath& path) {
    BsdfSample sample;
    sample.wi = lanes_.next_direction[lane];
    sample.weight = lanes_.next_weight[lane];
    sample.pdf_solid_angle = lanes_.next_pdf[lane];
    if (!scatter(context, i, path.point, sample)) return false;
    if (words_.are_followed())
        states_[i].words = words_.scatter_from_eye(states_[i].words, wide_event(context, path, sample.wi));
    rays_[i].origin = lanes_.next_origin[lane];
    return true;
}

bool PathWave::scatter_at_surface(const Context& context, std::size_t i, const ShadedPath& path) {
    const World& world = context.world;
    PathState& state = states_[i];
    const SurfacePoint& point = path.point;
    const Scattering& scattering = *path.scattering;
    const BsdfSample& sample = path.sample;
    if (!scatter(context, i, point, sample)) return false;
    if (words_.are_followed())
        state.words = words_.scatter_from_eye(
            state.words,
            surface_event(scattering, sample.wi, sample.is_delta, TransportMode::Radiance, words_.label(world, point)));
    const auto* mirror = path.chooses_wavelength && sample.is_delta && !sample.is_transmission
                             ? std::get_if<SmoothDielectric>(&scattering.bsdf())
                             : nullptr;
    if (mirror != nullptr && mirror->fresnel.is_bare()) {
        // All wavelengths go where a mirror sends them, each with its own share: the path need not choose.
        state.throughput *= world.spectral_response().mean_over_chance(path.wavelength, [&](float nm) {
            const float cos_o = scattering.wo_local().z;
            const float ior = path.crossing->relative_ior(nm);
            return mirror->fresnel(std::min(1.0f, std::abs(cos_o)), cos_o > 0.0f ? ior : 1.0f / ior, cos_o > 0.0f)
                .reflection_share;
        });
    } else {
        state.throughput *= path.wavelength.weight;
        state.wavelength_nm = path.wavelength.nm;
    }
    if (sample.is_transmission) state.eta_scale *= sample.eta * sample.eta;
    rays_[i].origin = offset_origin(point.position, point.geometric_normal, point.clearance, sample.wi);
    if (path.crossing) interiors_[i] = beyond(*path.crossing, point, sample.wi);
    return true;
}

bool PathWave::scatter_in_medium(const Context& context, std::size_t i) {
    const HomogeneousMedium* medium = context.world.medium(interiors_[i]);
    if (medium == nullptr) return false;
    PathState& state = states_[i];
    Ray& ray = rays_[i];
    const MediumSample sample = medium->sample(state.throughput, hits_[i].t, medium_[i]);
    state.throughput *= sample.weight;
    if (!sample.scatters) return false;
    if (context.job.profile != nullptr) ++context.job.profile->use().phase_samples;

    const Vec3f position = ray.origin + ray.direction * sample.distance;
    const bool samples_lights = context.options.sample_lights && context.world.has_lights_in_media();
    if (samples_lights && state.edges >= context.options.lengths.min_depth)
        queue_direct_light_in_medium(context, i, position, *medium);
    const Vec3f wo = -ray.direction;
    ray.origin = position;
    ray.direction = medium->phase.sample(wo, bsdf_direction_[i]);
    ray.alpha_key = alpha_key(context, i);
    state.pdf_solid_angle = medium->phase.pdf_solid_angle(wo, ray.direction);
    if (!receivers_.empty()) receivers_[i] = position;
    state.after_delta = !samples_lights;
    state.is_direct = state.only_delta;
    state.only_delta = false;
    if (words_.are_followed()) state.words = words_.scatter_from_eye(state.words, VertexEvent{});
    state.cone = scatter_cone(state.cone.at(sample.distance), lobe_spread(state.pdf_solid_angle));
    return true;
}

void PathWave::pass_hidden(const Context& context, std::size_t i, const SurfacePoint& point, const Crossing& crossing) {
    PathState& state = states_[i];
    Ray& ray = rays_[i];
    // No light sample passes a boundary, so what the path meets next could not have been sampled.
    state.after_delta = true;
    state.cone = state.cone.at(hits_[i].t);
    ray.origin = offset_origin(point.position, point.geometric_normal, point.clearance, ray.direction);
    ray.alpha_key = alpha_key(context, i);
    interiors_[i] = beyond(crossing, point, ray.direction);
}

}  // namespace etendue
