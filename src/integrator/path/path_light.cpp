#include "integrator/path/path_light.h"

#include "bsdf/gloss.h"
#include "core/in_place.h"
#include "core/vector_bytes.h"
#include "transport/bodies.h"
#include "transport/connecting_ray.h"
#include "transport/direct_light.h"
#include "transport/shadow_catcher.h"

#include <algorithm>

namespace etendue {

LightReceiver PathLight::make_receiver(std::size_t k) const {
    const ShadedPath& path = block_.paths[k];
    if (!path.is_wide) return light_receiver(block_.lanes.position[k], *block_.singles[k].scattering);
    const Vec3f wo = block_.lanes.wo[k];
    const Vec3f normal = block_.lanes.normal[k];
    LightReceiver receiver(block_.lanes.position[k],
                           dot(block_.lanes.geometric_normal[k], wo) < 0.0f ? -normal : normal);
    receiver.wo = wo;
    if (path.glossy == nullptr) return receiver;
    const Gloss gloss = gloss_of(*path.glossy, abs_dot(receiver.normal, wo));
    receiver.glossy = gloss.share;
    receiver.alpha = gloss.alpha;
    return receiver;
}

void PathLight::sample(const PathContext& context, const LaneList& paths, std::uint32_t round) {
    if (paths.empty()) return;
    LightChoices chosen;
    choose_lights(context, paths, round, chosen);
    if (!chosen.by_mesh.empty()) sample_meshes(paths, chosen);
    if (!chosen.by_environment.empty()) sample_environment(context.world, paths, chosen);
    for (const std::size_t place : chosen.singly) {
        const std::size_t k = paths[place];
        make_in_place(block_.lights[k], [&] {
            return context.world.lights().sample(chosen.choices[place], block_.lanes.position[k],
                                                 block_.light_numbers(k), paths_.time[block_.first + k]);
        });
    }
    // What is where those who ask next do not look for it.
    for (const std::size_t place : chosen.by_mesh)
        if (const std::size_t k = paths[place]; !block_.paths[k].is_wide) take_from_lanes(k);
    for (const LaneList* list : {&chosen.by_environment, &chosen.singly})
        for (const std::size_t place : *list)
            if (const std::size_t k = paths[place]; block_.paths[k].is_wide) put_into_lanes(k);
}

void PathLight::choose_lights(const PathContext& context, const LaneList& paths, std::uint32_t round,
                              LightChoices& chosen) {
    const World& world = context.world;
    const std::size_t count = paths.size();
    std::array<Vec2f, kBlockLanes> u;
    for (std::size_t place = 0; place < count; ++place) {
        const std::size_t k = paths[place];
        if (!paths_.receivers.empty()) {
            if (round == 0) paths_.receivers[block_.first + k] = make_receiver(k);
            receivers_[place] = paths_.receivers[block_.first + k];
        }
        u[place] = block_.light_choice[k];
    }
    world.lights().choose(std::span(receivers_).first(count), std::span(u).first(count),
                          std::span(chosen.choices).first(count));
    if (context.settings.light_samples > 1)
        for (std::size_t place = 0; place < count; ++place)
            share_estimate(chosen.choices[place],
                           paths_.light_samples(context, block_.first + paths[place], path_history::kOnlyDeltas));
    for (std::size_t place = 0; place < count; ++place) {
        const std::uint32_t light = block_.paths[paths[place]].light = chosen.choices[place].light;
        chosen.meshes[place] = world.lights().even_mesh(light);
        const bool is_mesh = chosen.meshes[place] != nullptr;
        const bool is_environment = light == world.environment().light();
        chosen.by_mesh.add_if(is_mesh, place);
        chosen.by_environment.add_if(is_environment, place);
        chosen.singly.add_if(!is_mesh && !is_environment, place);
    }
}

void PathLight::sample_meshes(const LaneList& paths, const LightChoices& chosen) {
    const std::size_t count = paths.size();
    std::array<Vec3f, kBlockLanes> points;
    std::array<Vec2f, kBlockLanes> u_triangle;
    std::array<Vec2f, kBlockLanes> u_direction;
    for (std::size_t place = 0; place < count; ++place) {
        points[place] = block_.lanes.position[paths[place]];
        u_triangle[place] = block_.light_triangle[paths[place]];
        u_direction[place] = block_.light_direction[paths[place]];
    }
    std::array<MeshLight::TriangleChoice, kBlockLanes> triangles;
    MeshLight::choose_triangles(std::span(chosen.meshes).first(count), points, u_triangle, u_direction, triangles);
    for (const std::size_t place : chosen.by_mesh) {
        const std::size_t k = paths[place];
        const MeshLight& mesh = *chosen.meshes[place];
        block_.lanes.front.set(k, mesh, triangles[place]);
        block_.lanes.u_light.set(k, triangles[place].u);
        block_.lanes.expected_samples.set(k, chosen.choices[place].probability);
        block_.lanes.light_radiance.set(k, mesh.radiance());
    }
    block_.lanes.sample_mesh_lights(block_.count);
}

void PathLight::sample_environment(const World& world, const LaneList& paths, const LightChoices& chosen) {
    const std::size_t count = chosen.by_environment.size();
    std::array<Vec2f, kBlockLanes> u;
    for (std::size_t i = 0; i < count; ++i) u[i] = block_.light_direction[paths[chosen.by_environment[i]]];
    world.environment().sample_light(std::span(u).first(count), std::span(environment_samples_).first(count));
    for (std::size_t i = 0; i < count; ++i) {
        const LightTree::Choice& choice = chosen.choices[chosen.by_environment[i]];
        ChosenLight& light = block_.lights[paths[chosen.by_environment[i]]];
        light = {environment_samples_[i], choice.probability, choice.light};
        light.sample.pdf_solid_angle *= choice.probability;
    }
}

void PathLight::take_from_lanes(std::size_t k) {
    LightSample& light = block_.lights[k].sample;
    light.wi = block_.lanes.light_wi[k];
    light.distance = block_.lanes.light_distance[k];
    light.end = block_.lanes.light_end[k];
    light.pdf_solid_angle = block_.lanes.light_pdf[k];
    light.radiance = light.pdf_solid_angle > 0.0f ? block_.lanes.light_radiance[k] : Rgb();
    light.is_delta = false;
}

void PathLight::put_into_lanes(std::size_t k) {
    const LightSample& light = block_.lights[k].sample;
    block_.lanes.light_wi.set(k, light.wi);
    block_.lanes.light_distance.set(k, light.distance);
    block_.lanes.light_end.set(k, light.end);
    block_.lanes.light_pdf.set(k, block_.lights[k].density());
    block_.lanes.light_by_chance.set(k, light.is_delta ? 0.0f : 1.0f);
    block_.lanes.light_radiance.set(k, light.radiance);
}

void PathLight::evaluate(std::size_t k) {
    SingleShading& path = block_.singles[k];
    const LightSample& light = block_.lights[k].sample;
    if (!is_black(light.radiance)) path.towards_light = path.scattering->evaluate(light.wi, TransportMode::Radiance);
}

void PathLight::add_environment(const PathContext& context) {
    const World& world = context.world;
    const bool is_shown = !world.environment().met(true).empty();
    LaneList meeting;
    std::array<Vec3f, kBlockLanes> directions;
    for (const std::size_t k : block_.escaped) {
        if (!is_shown && path_history::is_seen(paths_.history[block_.first + k])) {
            // A path without light has met a holdout, which has given it its alpha.
            const Rgb throughput = paths_.throughput[block_.first + k];
            if (!is_black(throughput)) alpha[paths_.slot[block_.first + k]] = alpha_over_background(throughput);
            continue;
        }
        if (!world.traits().has_environment || !context.settings.lengths.is_long_enough(paths_.edges(block_.first + k)))
            continue;
        directions[meeting.size()] = paths_.direction[block_.first + k];
        meeting.add(k);
    }
    if (meeting.empty()) return;
    std::array<EnvironmentRadiance, kBlockLanes> met;
    world.environment().look(std::span(directions).first(meeting.size()), std::span(met).first(meeting.size()));
    for (std::size_t m = 0; m < meeting.size(); ++m) {
        const std::size_t i = block_.first + meeting[m];
        const float weight = weight_from_afar(context, i, world.environment().light(), met[m].pdf_solid_angle);
        add(i, met[m].radiance * weight, paths_.words.light_source(world, world.environment().light()));
        if (!is_black(met[m].radiance)) count_met_light(context, i);
    }
}

void PathLight::count_met_light(const PathContext& context, std::size_t i) const {
    if (context.job.profile != nullptr && !path_history::is_seen(paths_.history[i]))
        ++context.job.profile->use().bsdf_met_light;
}

void PathLight::add_suns(const PathContext& context) {
    const World& world = context.world;
    for (const std::uint32_t light : world.environment().met(false)) {
        if (light == world.environment().light()) continue;
        for (const std::size_t k : block_.escaped) {
            const std::size_t i = block_.first + k;
            const float pdf = world.environment().pdf_solid_angle(light, paths_.direction[i]);
            if (!(pdf > 0.0f) || path_history::is_seen(paths_.history[i]) ||
                !context.settings.lengths.is_long_enough(paths_.edges(i)))
                continue;
            count_met_light(context, i);
            add(i, world.environment().radiance(light, paths_.direction[i]) * weight_from_afar(context, i, light, pdf),
                paths_.words.light_source(world, light));
        }
    }
}

float PathLight::weight_from_afar(const PathContext& context, std::size_t i, std::uint32_t light,
                                  float pdf_solid_angle) const {
    const std::uint32_t samples = paths_.samples_of_met_light(context, i);
    if (samples == 0) return 1.0f;
    return met_light_weight(paths_.pdf_solid_angle[i],
                            context.world.lights().probability(paths_.receiver(i), light) * pdf_solid_angle, samples);
}

void PathLight::add_emission(const PathContext& context, std::size_t k) {
    const std::size_t i = block_.first + k;
    const SurfacePoint& point = block_.singles[k].point;
    if (!context.settings.lengths.is_long_enough(paths_.edges(i))) return;
    if (context.rays == 1 && lamps.finds_emission(paths_.hits[i])) return;
    if (paths_.is(path_history::kOnlyDeltas, i) && paths_.edges(i) > 1 &&
        lamps.finds_image(paths_.samples[paths_.slot[i]]))
        return;
    const Vec3f direction = paths_.direction[i];
    const Rgb emitted = context.world.materials().emission(point, -direction);
    if (is_black(emitted)) return;
    count_met_light(context, i);
    float weight = 1.0f;
    if (const std::uint32_t samples = paths_.samples_of_met_light(context, i); samples > 0)
        weight = met_light_weight(
            paths_.pdf_solid_angle[i],
            context.world.lights().pdf_solid_angle(paths_.receiver(i), point, direction,
                                                   paths_.metres_passed(i) + paths_.hits[i].t, paths_.time[i]),
            samples);
    add(i, emitted * weight, paths_.words.surface_source(point));
}

void PathLight::queue_shadow_rays(const PathContext& context, const LaneList& paths, std::uint32_t round) {
    block_.lanes.weigh_light(block_.count, paths_, block_.first);
    if (context.job.profile != nullptr) context.job.profile->use().light_samples += paths.size();
    if (paths_.words.are_followed() || context.world.traits().has_bodies) {
        for (const std::size_t k : paths)
            if (block_.paths[k].is_wide && block_.lanes.arrives[k] != 0.0f) queue_shadow_ray_of_lane(context, k, round);
    } else {
        queue_shadow_rays_of_lanes(context, round);
    }
    for (const std::size_t k : paths)
        if (!block_.paths[k].is_wide) queue_shadow_ray_of_single(context, k, round);
}

void PathLight::queue_shadow_rays_of_lanes(const PathContext& context, std::uint32_t round) {
    const bool has_transparency = context.world.traits().has_transparency;
    for (std::size_t l = 0; l < block_.count; l += Wide::kWidth) {
        const std::size_t i = block_.first + l;
        std::array<std::uint32_t, Wide::kWidth> alpha_keys{};
        if (has_transparency)
            for (std::size_t k = l; k < std::min(l + Wide::kWidth, block_.count); ++k)
                alpha_keys[k - l] = paths_.shadow_alpha_key(context, block_.first + k, round);
        shadow_rays.to_sample({.origin = block_.lanes.shadow_origin.load(l),
                               .direction = block_.lanes.shadow_direction.load(l),
                               .t_max = block_.lanes.shadow_t_max.load(l),
                               .time = paths_.time.load(i),
                               .alpha_key = WideBits::load(alpha_keys.data()),
                               .slot = paths_.slot.load(i),
                               .contribution = block_.lanes.contribution.load(l),
                               .is_direct = paths_.are(path_history::kOnlyDeltas, i)},
                              block_.lanes.arrives.load(l) != Wide(0.0f) && block_.lanes.is_wide.load(l) != Wide(0.0f));
    }
}

void PathLight::queue_shadow_ray_of_single(const PathContext& context, std::size_t k, std::uint32_t round) {
    const SingleShading& path = block_.singles[k];
    const LightSample& light = block_.lights[k].sample;
    if (is_black(light.radiance) || is_black(path.towards_light.f_cos)) return;
    const SurfacePoint& point = path.point;
    Rgb contribution = paths_.throughput[block_.first + k] * path.towards_light.f_cos * light.radiance *
                       light_sample_scale(block_.lights[k], path.towards_light.pdf_solid_angle);
    if (context.world.traits().has_bodies) contribution *= path.wavelength.weight;
    queue_shadow_ray(
        context, k, round,
        {shadow_ray(offset_origin(point.position, point.geometric_normal, point.clearance, light.wi), light),
         light.distance, path.crossing ? &beyond(*path.crossing, point, light.wi) : nullptr, block_.paths[k].light},
        contribution,
        paths_.words.are_followed() ? surface_event(*path.scattering, light.wi, false, TransportMode::Radiance,
                                                    paths_.words.label(context.world, point))
                                    : VertexEvent{});
}

void PathLight::queue_shadow_ray_of_lane(const PathContext& context, std::size_t k, std::uint32_t round) {
    Ray ray;
    ray.origin = block_.lanes.shadow_origin[k];
    ray.direction = block_.lanes.shadow_direction[k];
    ray.t_max = block_.lanes.shadow_t_max[k];
    queue_shadow_ray(context, k, round, {ray, block_.lanes.light_distance[k], nullptr, block_.paths[k].light},
                     block_.lanes.contribution[k],
                     paths_.words.are_followed()
                         ? block_.wide_event(context.world, paths_.words, k, block_.lanes.light_wi[k])
                         : VertexEvent{});
}

LightNumbers PathLight::draw_numbers(const PathContext& context, std::size_t k, std::uint32_t round) const {
    const SampleKey key = paths_.light_sample_key(context, block_.first + k, round);
    const auto draw = [&](BounceDimension which) {
        return sample_2d(context.job.sequence, key, bounce_dimension(context.rays, which));
    };
    return {draw(kLightChoice), draw(kLightTriangle), draw(kLightDirection)};
}

void PathLight::queue_shadow_rays_in_medium(const PathContext& context, std::size_t k, const Vec3f& position,
                                            const HomogeneousMedium& medium) {
    const std::size_t i = block_.first + k;
    const std::uint32_t samples = paths_.light_samples(context, i, path_history::kOnlyDeltas);
    if (context.job.profile != nullptr) context.job.profile->use().light_samples += samples;
    for (std::uint32_t round = 0; round < samples; ++round) {
        const LightNumbers numbers = round == 0 ? block_.light_numbers(k) : draw_numbers(context, k, round);
        LightTree::Choice choice = context.world.lights().choose(position, numbers.light);
        share_estimate(choice, samples);
        const ChosenLight chosen = context.world.lights().sample(choice, position, numbers, paths_.time[i]);
        const LightSample& light = chosen.sample;
        if (is_black(light.radiance)) continue;
        const float phase = medium.phase.pdf_solid_angle(-paths_.direction[i], light.wi);
        queue_shadow_ray(context, k, round, {shadow_ray(position, light), light.distance, nullptr, chosen.light},
                         paths_.throughput[i] * light.radiance * (phase * light_sample_scale(chosen, phase)),
                         VertexEvent{});
    }
}

void PathLight::add(std::size_t i, const Rgb& light, const AovSet::Source& source) {
    const LightKind kind =
        kind_of_met_light(path_history::is_seen(paths_.history[i]), paths_.is(path_history::kIsDirect, i));
    shares_.clear();
    if (paths_.words.are_followed()) paths_.words.end_at_light(paths_.ranges[i], source, shares_);
    found.add(paths_.slot[i], paths_.throughput[i] * light, kind, shares_);
}

void PathLight::queue_shadow_ray(const PathContext& context, std::size_t k, std::uint32_t round, RayToLight to_light,
                                 Rgb contribution, const VertexEvent& event) {
    const std::size_t i = block_.first + k;
    Ray& ray = to_light.ray;
    ray.time = paths_.time[i];
    ray.alpha_key = paths_.shadow_alpha_key(context, i, round);
    if (context.world.traits().has_bodies)
        contribution *=
            transmittance(context.world, to_light.interior != nullptr ? *to_light.interior : paths_.interiors[i], ray,
                          to_light.distance);
    if (is_black(contribution)) return;
    shares_.clear();
    if (paths_.words.are_followed())
        paths_.words.end_at_light(paths_.ranges[i], event, paths_.words.light_source(context.world, to_light.light),
                                  shares_);
    shadow_rays.to_sample(ray, paths_.slot[i], contribution,
                          paths_.is(path_history::kOnlyDeltas, i) ? LightKind::Direct : LightKind::Indirect, shares_);
}

std::size_t PathLight::bytes() const {
    return found.bytes() + lamps.bytes() + shadow_rays.bytes() + vector_bytes(shares_, alpha);
}

}  // namespace etendue
