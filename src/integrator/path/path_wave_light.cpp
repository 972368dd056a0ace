// Light that paths meet, and light that is sampled for where they are.
#include "bsdf/gloss.h"
#include "core/in_place.h"
#include "integrator/path/path_wave.h"
#include "transport/bodies.h"
#include "transport/connecting_ray.h"
#include "transport/dimensions.h"
#include "transport/direct_light.h"

#include <algorithm>
#include <array>
#include <span>

namespace etendue {

namespace {

/// Returns how light that a path of this `history` meets comes to the eye.
LightKind kind_of_met_light(std::uint32_t history) {
    if (path_history::is_seen(history)) return LightKind::Seen;
    return (history & path_history::kIsDirect) != 0 ? LightKind::Direct : LightKind::Indirect;
}

}  // namespace

LightReceiver PathWave::make_receiver(std::size_t k) const {
    const ShadedPath& path = block_[k];
    if (!path.is_wide) return light_receiver(lanes_.position[k], *singles_[k].scattering);
    const Vec3f wo = lanes_.wo[k];
    const Vec3f normal = lanes_.normal[k];
    LightReceiver receiver(lanes_.position[k], dot(lanes_.geometric_normal[k], wo) < 0.0f ? -normal : normal);
    receiver.wo = wo;
    if (path.glossy == nullptr) return receiver;
    const Gloss gloss = gloss_of(*path.glossy, abs_dot(receiver.normal, wo));
    receiver.glossy = gloss.share;
    receiver.alpha = gloss.alpha;
    return receiver;
}

void PathWave::sample_lights(const Context& context, const LaneList& paths, std::uint32_t round) {
    if (paths.empty()) return;
    const World& world = context.world;
    const std::size_t count = paths.size();
    std::array<Vec2f, kBlock> u;
    for (std::size_t place = 0; place < count; ++place) {
        const std::size_t k = paths[place];
        if (!receivers_.empty()) {
            if (round == 0) receivers_[first_ + k] = make_receiver(k);
            to_light_[place] = receivers_[first_ + k];
        }
        u[place] = light_choice_[k];
    }
    std::array<LightTree::Choice, kBlock> choices;
    world.lights().choose(std::span(to_light_).first(count), std::span(u).first(count),
                          std::span(choices).first(count));
    if (context.settings.light_samples > 1)
        for (std::size_t place = 0; place < count; ++place)
            share_estimate(choices[place], light_samples(context, first_ + paths[place], path_history::kOnlyDelta));
    // Places among the paths, by how their lights are sampled.
    LaneList by_mesh;
    LaneList by_environment;
    LaneList singly;
    std::array<const MeshLight*, kBlock> meshes;
    std::array<Vec3f, kBlock> points;
    for (std::size_t place = 0; place < count; ++place) {
        const std::size_t k = paths[place];
        const std::uint32_t light = block_[k].light = choices[place].light;
        meshes[place] = world.lights().even_mesh(light);
        points[place] = lanes_.position[k];
        u[place] = light_triangle_[k];
        const bool is_mesh = meshes[place] != nullptr;
        const bool is_environment = light == world.environment().light();
        by_mesh.add_if(is_mesh, place);
        by_environment.add_if(is_environment, place);
        singly.add_if(!is_mesh && !is_environment, place);
    }
    std::array<MeshLight::TriangleChoice, kBlock> triangles;
    MeshLight::choose_triangles(std::span(meshes).first(count), points, u, triangles);
    for (const std::size_t place : by_mesh) {
        const std::size_t k = paths[place];
        const MeshLight& mesh = *meshes[place];
        lanes_.front.set(k, mesh, triangles[place]);
        lanes_.expected_samples.set(k, choices[place].probability);
        lanes_.light_radiance.set(k, mesh.radiance());
    }
    if (!by_mesh.empty()) {
        for (std::size_t l = 0; l < count_; l += Wide::kWidth) lanes_.u_light.store(l, light_direction_.load(l));
        lanes_.sample_mesh_lights(count_);
    }
    if (!by_environment.empty()) {
        const std::size_t samples = by_environment.size();
        for (std::size_t i = 0; i < samples; ++i) u[i] = light_direction_[paths[by_environment[i]]];
        world.environment().sample_light(std::span(u).first(samples), std::span(environment_samples_).first(samples));
        for (std::size_t i = 0; i < samples; ++i) {
            const LightTree::Choice& choice = choices[by_environment[i]];
            ChosenLight& light = lights_[paths[by_environment[i]]];
            light = {environment_samples_[i], choice.probability, choice.light};
            light.sample.pdf_solid_angle *= choice.probability;
        }
    }
    for (const std::size_t place : singly) {
        const std::size_t k = paths[place];
        make_in_place(lights_[k],
                      [&] { return world.lights().sample(choices[place], points[place], light_numbers(k)); });
    }
    // What is where those who ask next do not look for it.
    for (const std::size_t place : by_mesh)
        if (const std::size_t k = paths[place]; !block_[k].is_wide) take_light_from_lanes(k);
    for (const LaneList* list : {&by_environment, &singly})
        for (const std::size_t place : *list)
            if (const std::size_t k = paths[place]; block_[k].is_wide) put_light_into_lanes(k);
}

void PathWave::take_light_from_lanes(std::size_t k) {
    LightSample& light = lights_[k].sample;
    light.wi = lanes_.light_wi[k];
    light.distance = lanes_.light_distance[k];
    light.end = lanes_.light_end[k];
    light.pdf_solid_angle = lanes_.light_pdf[k];
    light.radiance = light.pdf_solid_angle > 0.0f ? lanes_.light_radiance[k] : Rgb();
    light.is_delta = false;
}

void PathWave::put_light_into_lanes(std::size_t k) {
    const LightSample& light = lights_[k].sample;
    lanes_.light_wi.set(k, light.wi);
    lanes_.light_distance.set(k, light.distance);
    lanes_.light_end.set(k, light.end);
    lanes_.light_pdf.set(k, light.is_delta ? lights_[k].expected_samples : light.pdf_solid_angle);
    lanes_.light_by_chance.set(k, light.is_delta ? 0.0f : 1.0f);
    lanes_.light_radiance.set(k, light.radiance);
}

void PathWave::add_environment(const Context& context) {
    const World& world = context.world;
    const bool is_shown = world.traits().has_environment && world.traits().environment_visible_to_camera;
    LaneList meeting;
    std::array<Vec3f, kBlock> directions;
    for (const std::size_t k : escaped_) {
        if (!is_shown && path_history::is_seen(paths_.history[first_ + k])) {
            alpha_[paths_.slot[first_ + k]] = 0.0f;
            continue;
        }
        if (!world.traits().has_environment || paths_.edges(first_ + k) < context.settings.lengths.min_depth) continue;
        directions[meeting.size()] = paths_.direction[first_ + k];
        meeting.add(k);
    }
    if (meeting.empty()) return;
    if (context.job.profile != nullptr && context.depth > 1)
        context.job.profile->use().bsdf_met_light += meeting.size();
    std::array<EnvironmentRadiance, kBlock> met;
    world.environment().look(std::span(directions).first(meeting.size()), std::span(met).first(meeting.size()));
    for (std::size_t m = 0; m < meeting.size(); ++m) {
        const std::size_t i = first_ + meeting[m];
        float weight = 1.0f;
        if (const std::uint32_t samples = samples_of_met_light(context, i); samples > 0)
            weight = met_light_weight(
                paths_.pdf_solid_angle[i],
                world.lights().probability(receiver(i), world.environment().light()) * met[m].pdf_solid_angle, samples);
        add_light(i, met[m].radiance * weight, words_.environment_source());
    }
}

void PathWave::add_emission(const Context& context, std::size_t k) {
    const std::size_t i = first_ + k;
    const SurfacePoint& point = singles_[k].point;
    if (paths_.edges(i) < context.settings.lengths.min_depth) return;
    if (context.depth == 1 && lamps_.finds(hits_[i])) return;
    const Vec3f direction = paths_.direction[i];
    const Rgb emitted = context.world.materials().emission(point, -direction);
    if (is_black(emitted)) return;
    if (context.job.profile != nullptr && context.depth > 1) ++context.job.profile->use().bsdf_met_light;
    float weight = 1.0f;
    if (const std::uint32_t samples = samples_of_met_light(context, i); samples > 0)
        weight = met_light_weight(
            paths_.pdf_solid_angle[i],
            context.world.lights().pdf_solid_angle(receiver(i), point, direction, passed(i) + hits_[i].t), samples);
    add_light(i, emitted * weight, words_.surface_source(point));
}

void PathWave::queue_direct_light(const Context& context, const LaneList& paths, std::uint32_t round) {
    lanes_.weigh_light(count_, paths_, first_);
    if (context.job.profile != nullptr) context.job.profile->use().light_samples += paths.size();
    if (words_.are_followed() || context.world.traits().has_bodies) {
        for (const std::size_t k : paths)
            if (block_[k].is_wide && lanes_.arrives[k] != 0.0f) queue_by_lanes(context, k, round);
    } else {
        queue_by_lanes(context, round);
    }
    for (const std::size_t k : paths)
        if (!block_[k].is_wide) queue_singly(context, k, round);
}

void PathWave::queue_by_lanes(const Context& context, std::uint32_t round) {
    const bool has_transparency = context.world.traits().has_transparency;
    for (std::size_t l = 0; l < count_; l += Wide::kWidth) {
        const std::size_t i = first_ + l;
        std::array<std::uint32_t, Wide::kWidth> alpha_keys{};
        if (has_transparency)
            for (std::size_t k = l; k < std::min(l + Wide::kWidth, count_); ++k)
                alpha_keys[k - l] = shadow_alpha_key(context, k, round);
        shadow_rays_.to_sample({.origin = lanes_.shadow_origin.load(l),
                                .direction = lanes_.shadow_direction.load(l),
                                .t_max = lanes_.shadow_t_max.load(l),
                                .time = paths_.time.load(i),
                                .alpha_key = WideBits::load(alpha_keys.data()),
                                .slot = paths_.slot.load(i),
                                .contribution = lanes_.contribution.load(l),
                                .is_direct = paths_.are(path_history::kOnlyDelta, i)},
                               lanes_.arrives.load(l) != Wide(0.0f) && lanes_.is_wide.load(l) != Wide(0.0f));
    }
}

void PathWave::queue_singly(const Context& context, std::size_t k, std::uint32_t round) {
    const SingleShading& path = singles_[k];
    const LightSample& light = lights_[k].sample;
    if (is_black(light.radiance) || is_black(path.towards_light.f_cos)) return;
    const SurfacePoint& point = path.point;
    Rgb contribution = paths_.throughput[first_ + k] * path.towards_light.f_cos * light.radiance *
                       light_sample_scale(lights_[k], path.towards_light.pdf_solid_angle);
    if (context.world.traits().has_bodies)
        contribution *= path.wavelength.weight *
                        transmittance(context.world,
                                      path.crossing ? beyond(*path.crossing, point, light.wi) : interiors_[first_ + k],
                                      light.distance);
    queue(context, k, round,
          shadow_ray(offset_origin(point.position, point.geometric_normal, point.clearance, light.wi), light),
          contribution, block_[k].light,
          words_.are_followed() ? surface_event(*path.scattering, light.wi, false, TransportMode::Radiance,
                                                words_.label(context.world, point))
                                : VertexEvent{});
}

void PathWave::queue_by_lanes(const Context& context, std::size_t k, std::uint32_t round) {
    Rgb contribution = lanes_.contribution[k];
    if (context.world.traits().has_bodies)
        contribution *= transmittance(context.world, interiors_[first_ + k], lanes_.light_distance[k]);
    Ray ray;
    ray.origin = lanes_.shadow_origin[k];
    ray.direction = lanes_.shadow_direction[k];
    ray.t_max = lanes_.shadow_t_max[k];
    queue(context, k, round, ray, contribution, block_[k].light,
          words_.are_followed() ? wide_event(context, k, lanes_.light_wi[k]) : VertexEvent{});
}

LightNumbers PathWave::light_numbers(const Context& context, std::size_t k, std::uint32_t round) const {
    const SampleKey key = light_sample_key(context, k, round);
    const auto draw = [&](BounceDimension which) {
        return sample_2d(context.job.sequence, key, bounce_dimension(context.depth, which));
    };
    return {draw(kLightChoice), draw(kLightTriangle), draw(kLightDirection)};
}

void PathWave::queue_direct_light_in_medium(const Context& context, std::size_t k, const Vec3f& position,
                                            const HomogeneousMedium& medium) {
    const std::size_t i = first_ + k;
    const std::uint32_t samples = light_samples(context, i, path_history::kOnlyDelta);
    if (context.job.profile != nullptr) context.job.profile->use().light_samples += samples;
    for (std::uint32_t round = 0; round < samples; ++round) {
        const LightNumbers numbers = round == 0 ? light_numbers(k) : light_numbers(context, k, round);
        LightTree::Choice choice = context.world.lights().choose(position, numbers.light);
        share_estimate(choice, samples);
        const ChosenLight chosen = context.world.lights().sample(choice, position, numbers);
        const LightSample& light = chosen.sample;
        if (is_black(light.radiance)) continue;
        const float phase = medium.phase.pdf_solid_angle(-paths_.direction[i], light.wi);
        queue(context, k, round, shadow_ray(position, light),
              paths_.throughput[i] * light.radiance * medium.transmittance(light.distance) *
                  (phase * light_sample_scale(chosen, phase)),
              chosen.light, VertexEvent{});
    }
}

void PathWave::add_light(std::size_t i, const Rgb& light, const AovSet::Source& source) {
    const LightKind kind = kind_of_met_light(paths_.history[i]);
    shares_.clear();
    if (words_.are_followed()) words_.end_at_light(ranges_[i], source, shares_);
    light_.add(paths_.slot[i], paths_.throughput[i] * light, kind, shares_);
}

void PathWave::queue(const Context& context, std::size_t k, std::uint32_t round, Ray ray, const Rgb& contribution,
                     std::uint32_t light, const VertexEvent& event) {
    if (is_black(contribution)) return;
    const std::size_t i = first_ + k;
    shares_.clear();
    if (words_.are_followed())
        words_.end_at_light(ranges_[i], event, words_.light_source(context.world, light), shares_);
    ray.time = paths_.time[i];
    ray.alpha_key = shadow_alpha_key(context, k, round);
    shadow_rays_.to_sample(ray, paths_.slot[i], contribution,
                           paths_.is(path_history::kOnlyDelta, i) ? LightKind::Direct : LightKind::Indirect, shares_);
}

}  // namespace etendue
