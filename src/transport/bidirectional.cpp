#include "transport/bidirectional.h"

#include "transport/bodies.h"
#include "transport/connecting_ray.h"
#include "transport/direct_light.h"
#include "transport/roulette.h"
#include "transport/strategy_sums.h"

#include <cmath>

namespace etendue {

namespace {

bool wants(const SubpathSample& sample, int edges) {
    return edges >= sample.lengths.min_depth && edges <= sample.lengths.max_depth;
}

float weight(const StrategySums& sums) {
    return static_cast<float>(sums.weight());
}

/// Returns the light of s = 0: what an eye subpath meets at `vertex`, where it arrives with `arrived`.
Rgb light_met(const SubpathSample& sample, const Subpath& eye, const Vertex& vertex, const SubpathDensities& arrived) {
    const World& world = sample.world();
    const bool is_seen = eye.index == kDirectlySeen;
    const Vec3f direction = -vertex.wo;
    if (eye.edges < sample.lengths.min_depth) return {};
    const Rgb throughput = eye.throughput * sample.wavelength_weight(eye.is_dispersed);
    if (vertex.kind == Vertex::Kind::Environment) {
        Rgb met;
        for (const std::uint32_t light : world.environment().met(is_seen)) {
            const Rgb radiance = world.environment().radiance(light, direction);
            if (is_black(radiance)) continue;
            StrategySums sums;
            if (!is_seen) sums = sums_from_afar(sample.mis, eye.from, light, direction, eye.departing);
            met += radiance * weight(sums);
        }
        return throughput * met;
    }
    const SurfacePoint& point = vertex.surface;
    Rgb light;
    if (const Rgb emitted = point.material->emits ? world.materials().emission(point, vertex.wo) : Rgb();
        !is_black(emitted)) {
        const std::uint32_t lamp = world.lights().at(point);
        StrategySums sums;
        if (!is_seen && lamp != kNone)
            sums = sums_at_emitter(sample.mis, eye.from, lamp, point.triangle, direction,
                                   dot(vertex.wo, point.geometric_normal), arrived);
        else if (eye.is_direct && lamp != kNone)
            sums = sums_at_seen_emitter(sample.mis, lamp, arrived);
        light += emitted * weight(sums);
    }
    // An unlit surface lights nothing.
    if (vertex.kind == Vertex::Kind::Unlit && eye.only_deltas) light += world.materials().unlit_color(point);
    return throughput * light;
}

/// Returns the light of s = 1: `eye` is connected to a light that is sampled for it.
Rgb light_sampled(const SubpathSample& sample, const SubpathVertex& eye) {
    const World& world = sample.world();
    if (!world.traits().has_sampled_lights || !wants(sample, eye.next_edges)) return {};
    const auto draw = [&](SubpathDimension which) { return sample.pair(SubpathEnd::AtEye, eye.index, which); };
    const LightNumbers u{draw(SubpathDimension::LightChoice), draw(SubpathDimension::LightTriangle),
                         draw(SubpathDimension::LightDirection)};
    const ChosenLight chosen = world.lights().sample(eye.position, u);
    const LightSample& light = chosen.sample;
    if (is_black(light.radiance)) return {};
    const auto scattered = eye.evaluate_both_ways(light.wi, TransportMode::Radiance);
    if (is_black(scattered.f_cos)) return {};
    const float share = weight(sums_of_light_sample(sample.mis, eye, chosen, scattered));
    return light_contribution(world, eye, eye.throughput * sample.wavelength_weight(eye.is_dispersed), light,
                              scattered.f_cos,
                              share / (light.is_delta ? chosen.expected_samples : light.pdf_solid_angle),
                              {sample.eye.ray.time, sample.connection_key(SubpathEnd::AtEye, eye.index)});
}

/// Returns the light of s > 1 and t > 1: `eye` is connected to `light`.
Rgb light_connected(const SubpathSample& sample, const SubpathVertex& eye, const SubpathVertex& light) {
    const World& world = sample.world();
    if (!wants(sample, eye.next_edges + light.next_edges - 1)) return {};
    const Vec3f to_light = light.position - eye.position;
    const float squared = length_squared(to_light);
    if (!(squared > 0.0f)) return {};
    const Vec3f w = to_light * (1.0f / std::sqrt(squared));
    // Between different media lies a boundary, which no connection passes.
    if (world.media().within(eye.interior_towards(w)) != world.media().within(light.interior_towards(-w))) return {};
    const auto at_eye = eye.evaluate_both_ways(w, TransportMode::Radiance);
    const auto at_light = light.evaluate_both_ways(-w, TransportMode::Importance);
    if (is_black(at_eye.f_cos) || is_black(at_light.f_cos)) return {};
    const float share = weight(sums_between(sample.mis.raised, eye, light, w, squared, at_eye, at_light));
    Ray ray = connecting_ray(eye.origin_towards(w), light.origin_towards(-w));
    ray.time = sample.eye.ray.time;
    ray.alpha_key =
        sample.connection_key(SubpathEnd::AtEye, eye.index) + sample.connection_key(SubpathEnd::AtLight, light.index);
    return eye.throughput * at_eye.f_cos * at_light.f_cos * light.throughput *
           transmittance(world, eye.interior_towards(w), std::sqrt(squared)) *
           sample.wavelength_weight(eye.is_dispersed || light.is_dispersed) * (share / squared) *
           visibility(world, ray);
}

/// Returns the light that `eye` takes from photons around it.
Rgb light_merged(const SubpathSample& sample, const SubpathVertex& eye, const PhotonMap& photons) {
    const MergeKernel kernel{eye.position, eye.surface.geometric_normal, sample.mis.merging.radius(eye.position),
                             eye.surface.clearance};
    Rgb light;
    photons.for_each_in(kernel, [&](const Photon& photon) {
        if (!wants(sample, eye.next_edges - 1 + photon.edges)) return;
        const auto scattered = eye.evaluate_both_ways(photon.direction, TransportMode::Radiance);
        light += merged_light(sample.mis, eye, eye.throughput, photon, scattered) *
                 sample.wavelength_weight(eye.is_dispersed || photon.is_dispersed);
    });
    return light;
}

/// Returns the light of t = 1: `light` is connected to the lens; black if the film does not show it.
FilmLight light_at_lens(const SubpathSample& sample, const SubpathVertex& light) {
    const World& world = sample.world();
    if (light.is_hidden_from_camera() || !wants(sample, light.next_edges)) return {};
    const Vec2f lens = sample.pair(SubpathEnd::AtLight, light.index, SubpathDimension::LightChoice);
    const auto view = view_from_lens(world, light.position, lens, sample.eye.ray.time);
    if (!view) return {};
    const auto scattered = light.evaluate_both_ways(view->direction, TransportMode::Importance);
    if (is_black(scattered.f_cos)) return {};
    const StrategySums sums = sums_at_lens(sample.mis, light, view->direction, view->camera, scattered);
    return vertex_to_camera(sample, light, *view, scattered.f_cos, weight(sums));
}

SubpathSample subpath_sample(const World& world, const EyeSample& eye, const IntegratorSettings& settings,
                             const BidirectionalSetup& setup) {
    return {{world, Raised{settings.heuristic}, setup.samples_per_light_path, setup.merging},
            settings.lengths,
            eye,
            setup.shared};
}

}  // namespace

BidirectionalLight bidirectional_light(const World& world, const EyeSample& eye_sample,
                                       const IntegratorSettings& settings, const BidirectionalSetup& setup) {
    const PathLengths& lengths = settings.lengths;
    const SubpathSample sample = subpath_sample(world, eye_sample, settings, setup);
    const SparedRays spared = spared_rays(lengths.roulette_depth);

    BidirectionalLight found;
    const auto eye = follow_subpath(sample, begin_subpath_at_eye(sample), spared.of_eye,
                                    [&](const Subpath& subpath, const Vertex& vertex, const SubpathDensities& arrived) {
                                        found.radiance += light_met(sample, subpath, vertex, arrived);
                                    });
    const std::optional<Subpath> from_light = begin_subpath_at_light(sample);
    if (!from_light) return found;
    for (const SubpathVertex& vertex : eye) found.radiance += light_sampled(sample, vertex);

    const Emission& emission = *from_light->emission;
    const auto keep = [&](const FilmLight& light) {
        if (!is_black(light.value)) found.on_film.push_back(light);
    };
    if (wants(sample, 1))
        if (const auto lamp = lamp_to_camera(sample, emission, [&](const LensView& view, float cosine) {
                return weight(sums_of_seen_light(sample.mis, emission, view.camera, cosine));
            }))
            keep(*lamp);
    if (lengths.max_depth < edges_to_connect(world) || is_black(emission.weight)) return found;

    const auto light = follow_subpath(sample, *from_light, spared.of_light);
    for (const SubpathVertex& at_eye : eye)
        for (const SubpathVertex& at_light : light) found.radiance += light_connected(sample, at_eye, at_light);
    for (const SubpathVertex& vertex : light) keep(light_at_lens(sample, vertex));
    if (setup.photons != nullptr)
        for (const SubpathVertex& vertex : eye)
            if (vertex.merges) found.radiance += light_merged(sample, vertex, *setup.photons);
    return found;
}

std::vector<Photon> photons_of_sample(const World& world, const EyeSample& eye_sample,
                                      const IntegratorSettings& settings, const BidirectionalSetup& setup) {
    const SubpathSample sample = subpath_sample(world, eye_sample, settings, setup);
    const std::optional<Subpath> from_light = begin_subpath_at_light(sample);
    std::vector<Photon> photons;
    if (!from_light || settings.lengths.max_depth < edges_to_connect(world) || is_black(from_light->emission->weight))
        return photons;
    for (const SubpathVertex& vertex :
         follow_subpath(sample, *from_light, spared_rays(settings.lengths.roulette_depth).of_light))
        if (vertex.merges) photons.push_back(make_photon(vertex, vertex.surface.geometric_normal));
    return photons;
}

}  // namespace etendue
