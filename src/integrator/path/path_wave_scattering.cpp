// Where paths are, and where surfaces and media send them.
#include "core/in_place.h"
#include "integrator/path/path_wave.h"
#include "transport/bodies.h"
#include "transport/dimensions.h"
#include "transport/dispersion.h"
#include "transport/scattered_cone.h"

#include <algorithm>
#include <cmath>

namespace etendue {

void PathWave::set_up(const Context& context) {
    const World& world = context.world;
    for (LaneList* list : {&escaped_, &on_emitter_, &on_hidden_, &on_surface_}) list->clear();
    LaneList has_hit;
    for (std::size_t k = 0; k < count_; ++k) {
        const bool is_valid = hits_[first_ + k].valid();
        has_hit.add_if(is_valid, k);
        escaped_.add_if(!is_valid, k);
    }
    for (const std::size_t k : escaped_) end_path(context, k, PathEnding::Escaped);
    for (const std::size_t k : has_hit) {
        const std::size_t i = first_ + k;
        if (world.traits().has_bodies && scatter_in_medium(context, k)) {
            lanes_.goes_on.set(k, 1.0f);
            continue;
        }
        const PlainSurface* const plain = block_[k].plain = world.materials().plain_surface(hits_[i]);
        if (plain == nullptr && !set_up_any(context, k)) continue;
        if (paths_.edges(i) < context.settings.lengths.max_depth ||
            (plain == nullptr && singles_[k].point.material->is_pane))
            on_surface_.add(k);
        else
            end_path(context, k, PathEnding::TooLong);
    }
}

bool PathWave::set_up_any(const Context& context, std::size_t k) {
    const World& world = context.world;
    const std::size_t i = first_ + k;
    set_up_singly(context, k);
    SurfacePoint& point = singles_[k].point;
    if (world.traits().has_bodies && world.media().is_boundary(point))
        singles_[k].crossing.emplace(InPlace{[&] {
            return hits_[i].in_contact
                       ? world.media().contact_crossing(point, interiors_[i], hits_[i], paths_.ray(i), paths_.cone(i))
                       : world.media().crossing(point, interiors_[i]);
        }});
    if (point.material->is_pane) panes_[k] = {receiver(i), passed(i) + hits_[i].t};
    on_emitter_.add_if(point.material->emits, k);
    if (singles_[k].crossing && singles_[k].crossing->is_hidden) {
        on_hidden_.add(k);
        lanes_.goes_on.set(k, 1.0f);
        return false;
    }
    if (!point.material->unlit) return true;
    // Only what the eye sees directly or in mirrors shows an unlit surface; it lights nothing.
    if (paths_.is(path_history::kOnlyDelta, i) && paths_.edges(i) >= context.settings.lengths.min_depth)
        add_light(i, world.materials().unlit_color(point), words_.surface_source(point));
    end_path(context, k, PathEnding::Unlit);
    return false;
}

void PathWave::set_up_singly(const Context& context, std::size_t k) {
    const std::size_t i = first_ + k;
    block_[k].plain = nullptr;
    make_in_place(singles_[k].point,
                  [&] { return context.world.geometry().surface_point(hits_[i], paths_.ray(i), paths_.cone(i)); });
    singles_[k].crossing.reset();
}

void PathWave::set_up_plain(const Context& context) {
    const World& world = context.world;
    bool any = false;
    on_texture_.clear();
    for (std::size_t l = 0; l < count_; l += Wide::kWidth) {
        const Imath::Vec3<Wide> direction = paths_.direction.load(first_ + l);
        lanes_.wo.store(l, {-direction.x, -direction.y, -direction.z});
    }
    for (const std::size_t k : on_surface_) {
        const PlainSurface* const plain = block_[k].plain;
        if (plain == nullptr) continue;
        any = true;
        const Hit& hit = hits_[first_ + k];
        lanes_.set_hit(k, world.geometry().hit_triangle(hit), {hit.u, hit.v});
        if (words_.are_followed()) singles_[k].point.material = world.materials().at(hit);
        on_texture_.add_if(plain->textured != nullptr, k);
    }
    if (any) lanes_.set_up_points(count_);
    if (on_texture_.empty()) return;
    for (const std::size_t k : on_texture_) {
        const Hit& hit = hits_[first_ + k];
        textured_.set_hit(k, world.geometry().hit_coordinates(hit, *block_[k].plain),
                          std::abs(paths_.cone(first_ + k).width_at(hit.t)));
    }
    textured_.set_up(lanes_, count_);
}

void PathWave::look_up_textures(const Context& context) {
    if (on_texture_.empty()) return;
    const World& world = context.world;
    lookups_.clear();
    for (const std::size_t k : on_texture_)
        world.materials().add_lookups(*block_[k].plain, textured_.uv[k], textured_.footprint(k), lookups_);
    lookups_.finish();
    for (const std::size_t k : on_texture_) {
        textured_lobes_[k] = world.materials().lobe(*block_[k].plain, lookups_);
        if (!textured_lobes_[k].is_plain()) set_up_singly(context, k);
    }
}

void PathWave::make_scattering(const Context& context) {
    const bool samples_lights = context.samples_lights() && context.world.traits().has_sampled_lights;
    on_gloss_.clear();
    sampling_.clear();
    for (const std::size_t k : on_surface_) {
        ShadedPath& path = block_[k];
        set_wide(k, path.plain != nullptr);
        if (path.is_wide) {
            const PlainSurface& plain = *path.plain;
            path.glossy = plain.textured != nullptr ? &textured_lobes_[k] : plain.untextured_lobe();
            lanes_.albedo.set(k, plain.albedo);
            if (path.glossy != nullptr && words_.are_followed()) make_wide_scattering(k);
        } else {
            make_scattering_singly(context, k);
        }
        lanes_.is_glossy.set(k, path.glossy != nullptr ? 1.0f : 0.0f);
        on_gloss_.add_if(path.glossy != nullptr, k);
        const int edges = paths_.edges(first_ + k) + 1;
        sampling_.add_if(samples_lights && edges >= context.settings.lengths.min_depth &&
                             edges <= context.settings.lengths.max_depth &&
                             (path.is_wide || singles_[k].scattering->has_non_delta()),
                         k);
    }
}

void PathWave::make_wide_scattering(std::size_t k) {
    SingleShading& single = singles_[k];
    single.storage = *block_[k].glossy;
    single.scattering.emplace(single.storage, Frame{lanes_.tangent[k], lanes_.bitangent[k], lanes_.normal[k]},
                              lanes_.geometric_normal[k], lanes_.wo[k]);
}

void PathWave::make_scattering_singly(const Context& context, std::size_t k) {
    const World& world = context.world;
    const std::size_t i = first_ + k;
    ShadedPath& path = block_[k];
    SingleShading& single = singles_[k];
    const SurfacePoint& point = single.point;
    const std::optional<Crossing>& crossing = single.crossing;
    const Vec3f wo = lanes_.wo[k];
    path.glossy = nullptr;
    lanes_.position.set(k, point.position);
    // Where the index depends on the wavelength, a path of all of them takes one to go on with.
    single.wavelength = {paths_.wavelength_nm[i], Rgb(1.0f)};
    single.chooses_wavelength = crossing && crossing->disperses() && paths_.wavelength_nm[i] == 0.0f;
    if (single.chooses_wavelength)
        single.wavelength = world.spectral_response().sample(
            sample_2d(context.job.sequence, paths_.key(i), body_dimension(context.depth, kWavelength)).x);
    const Bsdf& bsdf = world.materials().bsdf(point, wo, crossing ? crossing->relative_ior(single.wavelength.nm) : 0.0f,
                                              single.storage);
    const auto* diffuse = std::get_if<Diffuse>(&bsdf);
    if (const auto* lobe = std::get_if<MetallicRoughness>(&bsdf); lobe != nullptr && lobe->is_plain() && !crossing)
        path.glossy = lobe;
    set_wide(k, path.glossy != nullptr || (diffuse != nullptr && !crossing));
    if (path.is_wide) {
        lanes_.geometric_normal.set(k, point.geometric_normal);
        lanes_.clearance.set(k, point.clearance);
        lanes_.tangent.set(k, point.shading.tangent);
        lanes_.bitangent.set(k, point.shading.bitangent);
        lanes_.normal.set(k, point.shading.normal);
        if (diffuse != nullptr) return lanes_.albedo.set(k, diffuse->albedo);
        if (!words_.are_followed()) return;
    }
    single.scattering.emplace(bsdf, point.shading, point.geometric_normal, wo);
}

void PathWave::evaluate_and_sample_matte() {
    for (std::size_t l = 0; l < count_; l += Wide::kWidth) lanes_.u_bsdf.store(l, bsdf_direction_.load(l));
    lanes_.evaluate_and_sample_matte(count_);
}

void PathWave::evaluate_and_sample_glossy() {
    if (on_gloss_.empty()) return;
    for (std::size_t g = 0; g < on_gloss_.size(); ++g) glossy_.set_lobe(g, *block_[on_gloss_[g]].glossy);
    glossy_.take(lanes_, count_, choices_, bsdf_direction_);
    glossy_.evaluate_and_sample(on_gloss_.size());
    glossy_.give(lanes_, count_);
}

void PathWave::evaluate_light(std::size_t k) {
    SingleShading& path = singles_[k];
    const LightSample& light = lights_[k].sample;
    if (!is_black(light.radiance)) path.towards_light = path.scattering->evaluate(light.wi, TransportMode::Radiance);
}

void PathWave::sample_bsdf(std::size_t k) {
    SingleShading& path = singles_[k];
    path.sample = path.scattering->sample(choices_[k].x, bsdf_direction_[k], TransportMode::Radiance);
}

VertexEvent PathWave::wide_event(const Context& context, std::size_t k, const Vec3f& wi) const {
    const auto label = words_.label(context.world, singles_[k].point);
    return block_[k].glossy == nullptr
               ? matte_event(label)
               : surface_event(*singles_[k].scattering, wi, false, TransportMode::Radiance, label);
}

void PathWave::scatter_by_lanes(const Context& context) {
    const World& world = context.world;
    if (context.job.profile != nullptr)
        for (const std::size_t k : on_surface_)
            if (block_[k].is_wide) count_sample(context, k, sample_of_lane(k));
    if (world.traits().has_textures) bend_cones(world);
    lanes_.scatter(count_, paths_, first_);
    if (!world.traits().has_transparency && !words_.are_followed()) return;
    for (const std::size_t k : on_surface_) {
        if (!block_[k].is_wide || lanes_.goes_on[k] == 0.0f) continue;
        paths_.alpha_key.set(first_ + k, alpha_key(context, k));
        if (words_.are_followed()) follow(k, wide_event(context, k, lanes_.next_direction[k]));
    }
}

void PathWave::count_sample(const Context& context, std::size_t k, const BsdfSample& sample) const {
    WaveProfile* const profile = context.job.profile;
    if (profile == nullptr) return;
    ++profile->use().bsdf_samples;
    if (!is_black(sample.weight)) return;
    ++profile->use().bsdf_absorbed;
    end_path(context, k, PathEnding::Absorbed);
}

BsdfSample PathWave::sample_of_lane(std::size_t k) const {
    BsdfSample sample;
    sample.weight = lanes_.next_weight[k];
    sample.pdf_solid_angle = lanes_.next_pdf[k];
    return sample;
}

void PathWave::bend_cone(const World& world, std::size_t k, const RayCone& arriving, const Vec3f& geometric_normal,
                         const BsdfSample& sample) {
    const std::size_t i = first_ + k;
    paths_.set_cone(i, scattered_cone(world, hits_[i], geometric_normal, paths_.direction[i], arriving, sample));
}

void PathWave::bend_cones(const World& world) {
    // All as if their lobes were wide; then once more those whose are not.
    LaneList narrow;
    std::array<RayCone, kBlock> arriving;
    for (const std::size_t k : on_surface_) {
        if (!block_[k].is_wide) continue;
        arriving[k] = arriving_cone(k);
        paths_.set_cone(first_ + k, scatter_cone(arriving[k], kMaxConeSpread));
        narrow.add_if(is_narrow_lobe(lanes_.next_pdf[k]), k);
    }
    for (const std::size_t k : narrow) bend_cone(world, k, arriving[k], lanes_.geometric_normal[k], sample_of_lane(k));
}

bool PathWave::scatter_at_surface(const Context& context, std::size_t k) {
    const World& world = context.world;
    const std::size_t i = first_ + k;
    const SingleShading& path = singles_[k];
    const SurfacePoint& point = path.point;
    const Scattering& scattering = *path.scattering;
    const BsdfSample& sample = path.sample;
    count_sample(context, k, sample);
    if (is_black(sample.weight)) return false;
    if (point.material->is_pane && sample.is_delta && sample.is_transmission) {
        pass_pane(context, k);
        return true;
    }
    if (paths_.edges(i) >= context.settings.lengths.max_depth) {
        end_path(context, k, PathEnding::TooLong);
        return false;
    }
    Rgb throughput = paths_.throughput[i] * sample.weight;
    paths_.pdf_solid_angle.set(i, sample.pdf_solid_angle);
    paths_.history.set(i, sample.is_delta ? path_history::after_delta(paths_.history[i])
                                          : path_history::after_lobe(paths_.history[i], 1));
    if (world.traits().has_textures) bend_cone(world, k, arriving_cone(k), point.geometric_normal, sample);
    if (words_.are_followed())
        follow(k, surface_event(scattering, sample.wi, sample.is_delta, TransportMode::Radiance,
                                words_.label(world, point)));
    if (path.chooses_wavelength && mirrors_all_wavelengths(scattering, sample)) {
        throughput *= world.spectral_response().mean_over_chance(
            path.wavelength, [&](float nm) { return mirrored_share(scattering, path.crossing->relative_ior(nm)); });
    } else {
        throughput *= path.wavelength.weight;
        paths_.wavelength_nm.set(i, path.wavelength.nm);
    }
    paths_.throughput.set(i, throughput);
    if (sample.is_transmission) paths_.eta_scale.set(i, paths_.eta_scale[i] * (sample.eta * sample.eta));
    paths_.origin.set(i, offset_origin(point.position, point.geometric_normal, point.clearance, sample.wi));
    paths_.direction.set(i, sample.wi);
    paths_.alpha_key.set(i, alpha_key(context, k));
    if (path.crossing) interiors_[i] = beyond(*path.crossing, point, sample.wi);
    return true;
}

bool PathWave::scatter_in_medium(const Context& context, std::size_t k) {
    const std::size_t i = first_ + k;
    const HomogeneousMedium* medium = context.world.media().within(interiors_[i]);
    if (medium == nullptr) return false;
    const MediumSample sample = medium->sample(paths_.throughput[i], hits_[i].t, medium_[k]);
    paths_.throughput.set(i, paths_.throughput[i] * sample.weight);
    if (!sample.scatters) return false;
    if (context.job.profile != nullptr) ++context.job.profile->use().phase_samples;

    const Vec3f wo = -paths_.direction[i];
    const Vec3f position = paths_.origin[i] - wo * sample.distance;
    const bool samples_lights = context.samples_lights() && context.world.traits().has_lights_in_media;
    if (samples_lights && paths_.edges(i) >= context.settings.lengths.min_depth)
        queue_direct_light_in_medium(context, k, position, *medium);
    const Vec3f direction = medium->phase.sample(wo, bsdf_direction_[k]);
    const float pdf_solid_angle = medium->phase.pdf_solid_angle(wo, direction);
    paths_.origin.set(i, position);
    paths_.direction.set(i, direction);
    paths_.alpha_key.set(i, alpha_key(context, k));
    paths_.pdf_solid_angle.set(i, pdf_solid_angle);
    if (!receivers_.empty()) receivers_[i] = position;
    if (!passed_.empty()) passed_[i] = 0.0f;
    const std::uint32_t history = path_history::after_lobe(paths_.history[i], 0);
    paths_.history.set(i, samples_lights ? history : history | path_history::kUnsampled);
    if (words_.are_followed()) follow(k, VertexEvent{});
    paths_.set_cone(i, scatter_cone(paths_.cone(i).at(sample.distance), lobe_spread(pdf_solid_angle)));
    return true;
}

void PathWave::pass_pane(const Context& context, std::size_t k) {
    const std::size_t i = first_ + k;
    const SingleShading& path = singles_[k];
    const SurfacePoint& point = path.point;
    paths_.throughput.set(i, paths_.throughput[i] * path.sample.weight);
    paths_.set_cone(i, paths_.cone(i).at(hits_[i].t));
    paths_.origin.set(i, offset_origin(point.position, point.geometric_normal, point.clearance, paths_.direction[i]));
    paths_.alpha_key.set(i, alpha_key(context, k));
    if (!receivers_.empty()) receivers_[i] = panes_[k].from;
    passed_[i] = panes_[k].passed;
}

void PathWave::pass_hidden(const Context& context, std::size_t k) {
    const std::size_t i = first_ + k;
    const SurfacePoint& point = singles_[k].point;
    const Vec3f direction = paths_.direction[i];
    // No light sample passes a boundary, so what the path meets next could not have been sampled.
    paths_.history.set(i, paths_.history[i] | path_history::kUnsampled);
    paths_.set_cone(i, paths_.cone(i).at(hits_[i].t));
    paths_.origin.set(i, offset_origin(point.position, point.geometric_normal, point.clearance, direction));
    paths_.alpha_key.set(i, alpha_key(context, k));
    interiors_[i] = beyond(*singles_[k].crossing, point, direction);
}

}  // namespace etendue
