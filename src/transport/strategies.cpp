#include "transport/strategies.h"

#include "transport/bodies.h"
#include "transport/connecting_ray.h"
#include "transport/direct_light.h"

#include <cmath>

namespace etendue {

void light_met(const SubpathSample& sample, const Subpath& eye, const Vertex& vertex, const SubpathDensities& arrived,
               const std::function<void(const StrategyLight&)>& add) {
    const World& world = sample.world();
    const bool is_seen = eye.index == kDirectlySeen;
    const Vec3f direction = -vertex.wo;
    if (!sample.lengths.is_long_enough(eye.edges)) return;
    const Rgb throughput = eye.throughput * sample.wavelength_weight(eye.is_dispersed);
    if (vertex.kind == Vertex::Kind::Environment) {
        for (const std::uint32_t light : world.environment().met(is_seen)) {
            const Rgb radiance = world.environment().radiance(light, direction);
            if (is_black(radiance)) continue;
            StrategySums sums;
            if (!is_seen) sums = sums_from_afar(sample.mis, eye.from, light, direction, eye.departing);
            add({throughput * radiance, sums});
        }
        return;
    }
    const SurfacePoint& point = vertex.surface;
    if (const Rgb emitted = point.material->emits ? world.materials().emission(point, vertex.wo) : Rgb();
        !is_black(emitted))
        add({throughput * emitted, sums_of_met_lamp(sample.mis, eye, point, vertex.wo, sample.eye.ray.time, arrived)});
    // An unlit surface lights nothing.
    if (vertex.kind == Vertex::Kind::Unlit && eye.only_deltas)
        add({throughput * world.materials().unlit_color(point), {}});
}

StrategyLight light_sampled(const SubpathSample& sample, const SubpathVertex& eye) {
    const World& world = sample.world();
    if (!world.traits().has_sampled_lights || !sample.lengths.keeps(eye.next_edges)) return {};
    const auto draw = [&](SubpathDimension which) { return sample.pair(SubpathEnd::AtEye, eye.index, which); };
    const LightNumbers u{draw(SubpathDimension::LightChoice), draw(SubpathDimension::LightTriangle),
                         draw(SubpathDimension::LightDirection)};
    const ChosenLight chosen = world.lights().sample(eye.position, u, sample.eye.ray.time);
    const LightSample& light = chosen.sample;
    if (is_black(light.radiance)) return {};
    const auto scattered = eye.evaluate_both_ways(light.wi, TransportMode::Radiance);
    if (is_black(scattered.f_cos)) return {};
    return {light_contribution(world, eye, eye.throughput * sample.wavelength_weight(eye.is_dispersed), light,
                               scattered.f_cos, 1.0f / chosen.density(),
                               {sample.eye.ray.time, sample.connection_key(SubpathEnd::AtEye, eye.index)}),
            sums_of_light_sample(sample.mis, eye, chosen, scattered)};
}

StrategyLight light_connected(const SubpathSample& sample, const SubpathVertex& eye, const SubpathVertex& light) {
    const World& world = sample.world();
    if (!sample.lengths.keeps(eye.next_edges + light.next_edges - 1)) return {};
    if (eye.is_in_dense() && light.is_in_dense()) return {};
    const Vec3f to_light = light.position - eye.position;
    const float squared = length_squared(to_light);
    if (!(squared > 0.0f)) return {};
    const Vec3f w = to_light * (1.0f / std::sqrt(squared));
    // Between different media lies a boundary, and connections pass none but clear ones.
    if (!world.traits().has_clear_bodies &&
        world.media().within(eye.interior_towards(w)) != world.media().within(light.interior_towards(-w)))
        return {};
    const auto at_eye = eye.evaluate_both_ways(w, TransportMode::Radiance);
    const auto at_light = light.evaluate_both_ways(-w, TransportMode::Importance);
    if (is_black(at_eye.f_cos) || is_black(at_light.f_cos)) return {};
    Ray ray = connecting_ray(eye.origin_towards(w), light.origin_towards(-w));
    ray.time = sample.eye.ray.time;
    ray.alpha_key =
        sample.connection_key(SubpathEnd::AtEye, eye.index) + sample.connection_key(SubpathEnd::AtLight, light.index);
    return {eye.throughput * at_eye.f_cos * at_light.f_cos * light.throughput *
                transmittance(world, eye.interior_towards(w), ray, std::sqrt(squared)) *
                sample.wavelength_weight(eye.is_dispersed || light.is_dispersed) * (1.0f / squared) *
                visibility(world, ray),
            sums_between(sample.mis.raised, eye, light, w, squared, at_eye, at_light)};
}

std::optional<StrategyOnFilm> lamp_at_lens(const SubpathSample& sample, const Emission& emission) {
    if (!sample.lengths.keeps(1)) return {};
    const World& world = sample.world();
    const Vec2f lens = sample.pair(SubpathEnd::AtLight, 0, SubpathDimension::LightChoice);
    const float time = sample.eye.ray.time;
    const auto view = view_from_lens(world, emission.sample.position, lens, time);
    if (!view) return {};
    const SurfaceEmission emitted = world.emitters().surface_emission(emission, view->direction);
    if (is_black(emitted.radiance)) return {};
    Ray ray = connecting_ray(world.emitters().origin(emission, view->direction), view->camera.lens);
    ray.time = time;
    ray.alpha_key = sample.connection_key(SubpathEnd::AtLight, 0);
    const Interior interior = interior_at_light(world, emission, view->direction);
    const Rgb shown =
        emitted.radiance * transmittance(world, interior, ray, view->distance, RayEnds::ToCamera) *
        (emitted.cosine * view->camera.importance_area / (emission.sample.pdf_position_area * emission.probability)) *
        visibility(world, ray, nullptr, RayEnds::ToCamera);
    return StrategyOnFilm{{shown, sums_of_seen_light(sample.mis, emission, view->camera, emitted.cosine)},
                          view->camera.film};
}

std::optional<StrategyOnFilm> light_at_lens(const SubpathSample& sample, const SubpathVertex& light) {
    const World& world = sample.world();
    if (!light.lights_camera() || !sample.lengths.keeps(light.next_edges)) return {};
    const Vec2f lens = sample.pair(SubpathEnd::AtLight, light.index, SubpathDimension::LightChoice);
    const auto view = view_from_lens(world, light.position, lens, sample.eye.ray.time);
    if (!view) return {};
    const auto scattered = light.evaluate_both_ways(view->direction, TransportMode::Importance);
    if (is_black(scattered.f_cos)) return {};
    Ray ray = connecting_ray(light.origin_towards(view->direction), view->camera.lens);
    ray.time = sample.eye.ray.time;
    ray.alpha_key = sample.connection_key(SubpathEnd::AtLight, light.index);
    const Rgb shown =
        light.throughput * scattered.f_cos * sample.wavelength_weight(light.is_dispersed) *
        transmittance(world, light.interior_towards(view->direction), ray, view->distance, RayEnds::ToCamera) *
        view->camera.importance_area * visibility(world, ray, nullptr, RayEnds::ToCamera);
    return StrategyOnFilm{{shown, sums_at_lens(sample.mis, light, view->direction, view->camera, scattered)},
                          view->camera.film};
}

void light_merged(const SubpathSample& sample, const SubpathVertex& eye, const PhotonMap& photons,
                  const std::function<void(const Photon&, const StrategyLight&)>& add) {
    const MergeKernel kernel =
        merge_kernel(sample.mis.merging, eye, eye.surface.geometric_normal, eye.surface.clearance);
    const double within = sample.mis.merging.expected_within(kernel.radius);
    photons.for_each_in(kernel, [&](const Photon& photon) {
        if (!sample.lengths.keeps(eye.next_edges - 1 + photon.edges)) return;
        const auto scattered = eye.evaluate_both_ways(photon.direction, TransportMode::Radiance);
        add(photon, {merged_light(eye, photon, scattered, 1.0, within) *
                         sample.wavelength_weight(eye.is_dispersed || photon.is_dispersed),
                     StrategySums::of_all_others(others_of_merge(sample.mis, eye, photon, scattered, within))});
    });
}

}  // namespace etendue
