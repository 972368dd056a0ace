// Where paths are, and where surfaces and media send them.
#include "core/in_place.h"
#include "integrator/path/path_dimensions.h"
#include "integrator/path/path_wave.h"
#include "integrator/scattered_cone.h"
#include "integrator/walk.h"

#include <algorithm>
#include <cmath>

namespace etendue {

bool PathWave::set_up(const Context& context, std::size_t k) {
    const World& world = context.world;
    const std::size_t i = first_ + k;
    const Hit& hit = hits_[i];
    ShadedPath& path = block_[k];
    path.emits = false;
    path.is_at_hidden = false;
    if (!hit.valid()) {
        end_path(context, k, PathEnding::Escaped);
        return false;
    }
    if (world.has_bodies() && scatter_in_medium(context, k)) {
        goes_on_[k] = true;
        return false;
    }
    const PathState& state = states_[i];
    path.plain = world.plain_surface(hit);
    if (path.plain == nullptr) {
        set_up_singly(context, k);
        const SurfacePoint& point = singles_[k].point;
        path.emits = point.material->emits;
        if (world.has_bodies() && world.is_boundary(point)) {
            const Crossing& crossing =
                singles_[k].crossing.emplace(InPlace{[&] { return world.crossing(point, interiors_[i]); }});
            if (crossing.is_hidden) {
                path.is_at_hidden = true;
                goes_on_[k] = true;
                return false;
            }
        }
        if (point.material->unlit) {
            // Only what the eye sees directly or in mirrors shows an unlit surface; it lights nothing.
            if (state.only_delta && state.edges >= context.options.lengths.min_depth)
                add_light(state, world.unlit_color(point), words_.surface_source(point));
            end_path(context, k, PathEnding::Unlit);
            return false;
        }
    }
    if (state.edges < context.options.lengths.max_depth) return true;
    end_path(context, k, PathEnding::TooLong);
    return false;
}

void PathWave::set_up_singly(const Context& context, std::size_t k) {
    const std::size_t i = first_ + k;
    block_[k].plain = nullptr;
    make_in_place(singles_[k].point, [&] { return context.world.surface_point(hits_[i], rays_[i], states_[i].cone); });
    singles_[k].crossing.reset();
}

void PathWave::set_up_plain(const Context& context) {
    const World& world = context.world;
    bool any = false;
    any_textured_ = false;
    for (std::size_t lane = 0; lane < surfaces_; ++lane) {
        const std::size_t k = on_surface_[lane];
        const std::size_t i = first_ + k;
        lanes_.wo.set(lane, -rays_[i].direction);
        const PlainSurface* const plain = block_[k].plain;
        if (plain == nullptr) continue;
        any = true;
        const Hit& hit = hits_[i];
        lanes_.set_hit(lane, world.hit_triangle(hit), {hit.u, hit.v});
        if (words_.are_followed()) singles_[k].point.material = world.material(hit);
        if (plain->textured == nullptr) continue;
        any_textured_ = true;
        textured_.set_hit(lane, world.hit_coordinates(hit, *plain), std::abs(states_[i].cone.width_at(hit.t)));
    }
    if (any) lanes_.set_up_points(surfaces_);
    if (any_textured_) textured_.set_up(lanes_, surfaces_);
}

void PathWave::look_up_textures(const Context& context) {
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
        const std::size_t k = on_surface_[lane];
        ShadedPath& path = block_[k];
        if (!is_textured(path)) continue;
        const MetallicRoughness& lobe = textured_lobes_[k] = world.lobe(*path.plain, lookups_);
        path.glossy = &lobe;
        if (!lobe.is_plain()) set_up_singly(context, k);
    }
}

void PathWave::make_scattering(const Context& context, std::size_t k, std::size_t lane) {
    const World& world = context.world;
    const PathState& state = states_[first_ + k];
    ShadedPath& path = block_[k];
    SingleShading& single = singles_[k];
    path.samples_light = context.options.sample_lights && world.has_sampled_lights() &&
                         state.edges + 1 >= context.options.lengths.min_depth;
    lanes_.throughput.set(lane, state.throughput);
    path.is_wide = path.plain != nullptr;
    if (path.is_wide) {
        if (path.plain->textured == nullptr) path.glossy = path.plain->matte == nullptr ? &path.plain->glossy : nullptr;
        if (path.glossy == nullptr) return lanes_.albedo.set(lane, std::get_if<Diffuse>(path.plain->matte)->albedo);
        if (words_.are_followed()) {
            single.storage = *path.glossy;
            single.scattering.emplace(single.storage,
                                      Frame{lanes_.tangent[lane], lanes_.bitangent[lane], lanes_.normal[lane]},
                                      lanes_.geometric_normal[lane], lanes_.wo[lane]);
        }
        return;
    }
    const SurfacePoint& point = single.point;
    const std::optional<Crossing>& crossing = single.crossing;
    const Vec3f wo = lanes_.wo[lane];
    path.glossy = nullptr;
    lanes_.position.set(lane, point.position);
    // Where the index depends on the wavelength, a path of all of them takes one to go on with.
    single.wavelength = {state.wavelength_nm, Rgb(1.0f)};
    single.chooses_wavelength = crossing && crossing->disperses() && state.wavelength_nm == 0.0f;
    if (single.chooses_wavelength)
        single.wavelength = world.spectral_response().sample(
            sample_2d(context.job.sequence, keys_[k], body_dimension(context.depth, kWavelength)).x);
    const Bsdf& bsdf =
        world.bsdf(point, wo, crossing ? crossing->relative_ior(single.wavelength.nm) : 0.0f, single.storage);
    const auto* diffuse = std::get_if<Diffuse>(&bsdf);
    if (const auto* lobe = std::get_if<MetallicRoughness>(&bsdf); lobe != nullptr && lobe->is_plain() && !crossing)
        path.glossy = lobe;
    path.is_wide = path.glossy != nullptr || (diffuse != nullptr && !crossing);
    if (path.is_wide) {
        lanes_.geometric_normal.set(lane, point.geometric_normal);
        lanes_.clearance.set(lane, point.clearance);
        lanes_.tangent.set(lane, point.shading.tangent);
        lanes_.bitangent.set(lane, point.shading.bitangent);
        lanes_.normal.set(lane, point.shading.normal);
        if (diffuse != nullptr) return lanes_.albedo.set(lane, diffuse->albedo);
        if (!words_.are_followed()) return;
    }
    single.scattering.emplace(bsdf, point.shading, point.geometric_normal, wo);
    path.samples_light = path.samples_light && single.scattering->has_non_delta();
}

void PathWave::evaluate_matte() {
    for (std::size_t lane = 0; lane < surfaces_; ++lane) lanes_.u.set(lane, bsdf_direction_[on_surface_[lane]]);
    lanes_.evaluate_matte(surfaces_);
}

void PathWave::evaluate_glossy() {
    std::array<std::uint8_t, kBlock> lane_of{};
    std::size_t count = 0;
    for (std::size_t lane = 0; lane < surfaces_; ++lane) {
        const std::size_t k = on_surface_[lane];
        if (block_[k].glossy == nullptr) continue;
        glossy_.set_lobe(count, *block_[k].glossy);
        glossy_.tangent.set(count, lanes_.tangent[lane]);
        glossy_.bitangent.set(count, lanes_.bitangent[lane]);
        glossy_.normal.set(count, lanes_.normal[lane]);
        glossy_.geometric_normal.set(count, lanes_.geometric_normal[lane]);
        glossy_.wo.set(count, lanes_.wo[lane]);
        glossy_.light_wi.set(count, lanes_.light_wi[lane]);
        glossy_.u_lobe.set(count, choices_[k].x);
        glossy_.u.set(count, bsdf_direction_[k]);
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

void PathWave::evaluate(std::size_t k) {
    SingleShading& path = singles_[k];
    const LightSample& light = lights_[k].sample;
    if (block_[k].samples_light && !is_black(light.radiance))
        path.towards_light = path.scattering->evaluate(light.wi, TransportMode::Radiance);
    path.sample = path.scattering->sample(choices_[k].x, bsdf_direction_[k], TransportMode::Radiance);
}

bool PathWave::scatter(const Context& context, std::size_t k, const Vec3f& geometric_normal, const BsdfSample& sample) {
    WaveProfile* const profile = context.job.profile;
    if (profile != nullptr) ++profile->use().bsdf_samples;
    if (is_black(sample.weight)) {
        if (profile != nullptr) ++profile->use().bsdf_absorbed;
        end_path(context, k, PathEnding::Absorbed);
        return false;
    }
    const std::size_t i = first_ + k;
    PathState& state = states_[i];
    state.throughput *= sample.weight;
    state.pdf_solid_angle = sample.pdf_solid_angle;
    state.after_delta = sample.is_delta;
    state.is_direct = state.only_delta;
    state.only_delta = state.only_delta && sample.is_delta;
    ++state.edges;
    if (context.world.has_textures())
        state.cone = scattered_cone(context.world, hits_[i], geometric_normal, rays_[i].direction,
                                    state.cone.at(hits_[i].t), sample);
    rays_[i].direction = sample.wi;
    rays_[i].alpha_key = alpha_key(context, k);
    return true;
}

VertexEvent PathWave::wide_event(const Context& context, std::size_t k, const Vec3f& wi) const {
    const auto label = words_.label(context.world, singles_[k].point);
    return block_[k].glossy == nullptr
               ? matte_event(label)
               : surface_event(*singles_[k].scattering, wi, false, TransportMode::Radiance, label);
}

bool PathWave::scatter_by_lanes(const Context& context, std::size_t k, std::size_t lane) {
    BsdfSample sample;
    sample.wi = lanes_.next_direction[lane];
    sample.weight = lanes_.next_weight[lane];
    sample.pdf_solid_angle = lanes_.next_pdf[lane];
    if (!scatter(context, k, lanes_.geometric_normal[lane], sample)) return false;
    const std::size_t i = first_ + k;
    if (words_.are_followed())
        states_[i].words = words_.scatter_from_eye(states_[i].words, wide_event(context, k, sample.wi));
    rays_[i].origin = lanes_.next_origin[lane];
    return true;
}

bool PathWave::scatter_at_surface(const Context& context, std::size_t k) {
    const World& world = context.world;
    const std::size_t i = first_ + k;
    PathState& state = states_[i];
    const SingleShading& path = singles_[k];
    const SurfacePoint& point = path.point;
    const Scattering& scattering = *path.scattering;
    const BsdfSample& sample = path.sample;
    if (!scatter(context, k, point.geometric_normal, sample)) return false;
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

bool PathWave::scatter_in_medium(const Context& context, std::size_t k) {
    const std::size_t i = first_ + k;
    const HomogeneousMedium* medium = context.world.medium(interiors_[i]);
    if (medium == nullptr) return false;
    PathState& state = states_[i];
    Ray& ray = rays_[i];
    const MediumSample sample = medium->sample(state.throughput, hits_[i].t, medium_[k]);
    state.throughput *= sample.weight;
    if (!sample.scatters) return false;
    if (context.job.profile != nullptr) ++context.job.profile->use().phase_samples;

    const Vec3f position = ray.origin + ray.direction * sample.distance;
    const bool samples_lights = context.options.sample_lights && context.world.has_lights_in_media();
    if (samples_lights && state.edges >= context.options.lengths.min_depth)
        queue_direct_light_in_medium(context, k, position, *medium);
    const Vec3f wo = -ray.direction;
    ray.origin = position;
    ray.direction = medium->phase.sample(wo, bsdf_direction_[k]);
    ray.alpha_key = alpha_key(context, k);
    state.pdf_solid_angle = medium->phase.pdf_solid_angle(wo, ray.direction);
    if (!receivers_.empty()) receivers_[i] = position;
    state.after_delta = !samples_lights;
    state.is_direct = state.only_delta;
    state.only_delta = false;
    if (words_.are_followed()) state.words = words_.scatter_from_eye(state.words, VertexEvent{});
    state.cone = scatter_cone(state.cone.at(sample.distance), lobe_spread(state.pdf_solid_angle));
    return true;
}

void PathWave::pass_hidden(const Context& context, std::size_t k) {
    const std::size_t i = first_ + k;
    const SurfacePoint& point = singles_[k].point;
    PathState& state = states_[i];
    Ray& ray = rays_[i];
    // No light sample passes a boundary, so what the path meets next could not have been sampled.
    state.after_delta = true;
    state.cone = state.cone.at(hits_[i].t);
    ray.origin = offset_origin(point.position, point.geometric_normal, point.clearance, ray.direction);
    ray.alpha_key = alpha_key(context, k);
    interiors_[i] = beyond(*singles_[k].crossing, point, ray.direction);
}

}  // namespace etendue
