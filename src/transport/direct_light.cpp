#include "transport/direct_light.h"

#include "transport/bodies.h"
#include "transport/connecting_ray.h"

namespace etendue {

namespace {

Rgb met_from_afar(const World& world, const EyePath& path, const Vertex& vertex) {
    const Vec3f direction = -vertex.wo;
    Rgb met;
    for (const std::uint32_t light : world.environment().met(path.is_seen())) {
        const Rgb radiance = world.environment().radiance(light, direction);
        if (is_black(radiance)) continue;
        met += radiance * met_light_weight(path.last.pdf_solid_angle,
                                           chosen_pdf_from_afar(world, path.last.receiver, light, direction),
                                           path.last.samples);
    }
    return met;
}

Rgb met_emission(const World& world, const EyePath& path, const Vertex& vertex) {
    const Rgb emitted = world.materials().emission(vertex.surface, vertex.wo);
    if (is_black(emitted)) return {};
    const float light_pdf = world.lights().pdf_solid_angle(path.last.receiver, vertex.surface, -vertex.wo,
                                                           path.last.passed + vertex.distance, path.ray.time);
    return emitted * met_light_weight(path.last.pdf_solid_angle, light_pdf, path.last.samples);
}

/// Returns true if whoever traces the path finds the emission at `vertex` by another estimate.
bool is_found_elsewhere(const EyePath& path, const Vertex& vertex) {
    return path.tracer != nullptr && path.rays == 1 && path.tracer->finds_emission(vertex.hit);
}

}  // namespace

Rgb met_light(const World& world, const EyePath& path, const Vertex& vertex) {
    Rgb light;
    if (vertex.kind == Vertex::Kind::Environment) light += met_from_afar(world, path, vertex);
    if (vertex.surface.material != nullptr && vertex.surface.material->emits && !is_found_elsewhere(path, vertex))
        light += met_emission(world, path, vertex);
    // An unlit surface lights nothing.
    if (vertex.kind == Vertex::Kind::Unlit && path.only_deltas) light += world.materials().unlit_color(vertex.surface);
    return path.throughput * light;
}

Rgb sampled_light(const World& world, const EyePath& path, const Vertex& vertex, const SampleNumbers& numbers,
                  const VertexNumbers& u, std::uint32_t samples) {
    const LightReceiver receiver = vertex.receiver();
    Rgb light;
    for (std::uint32_t round = 0; round < samples; ++round) {
        const SampleNumbers own{numbers.sequence, light_sample_key(numbers.key, samples, round)};
        const auto draw = [&](BounceDimension which) { return own.pair(bounce_dimension(path.rays, which)); };
        const LightNumbers u_light{draw(kLightChoice), draw(kLightTriangle), draw(kLightDirection)};
        LightTree::Choice choice = world.lights().choose(receiver, u_light.light);
        share_estimate(choice, samples);
        const ChosenLight chosen = world.lights().sample(choice, vertex.position, u_light, path.ray.time);
        if (is_black(chosen.sample.radiance)) continue;
        const BsdfValue value = vertex.evaluate(chosen.sample.wi);
        light += light_contribution(world, vertex, path.throughput * vertex.wavelength.weight, chosen.sample,
                                    value.f_cos, light_sample_scale(chosen, value.pdf_solid_angle),
                                    {path.ray.time, shadow_alpha_key(u.alpha_key, round), path.tracer});
    }
    return light;
}

Rgb light_contribution(const World& world, const Vertex& vertex, const Rgb& throughput, const LightSample& light,
                       const Rgb& f_cos, float scale, const ShadowTrace& trace) {
    Ray ray = shadow_ray(vertex.origin_towards(light.wi), light);
    ray.time = trace.time;
    ray.alpha_key = trace.alpha_key;
    const Rgb contribution = throughput * f_cos * light.radiance * scale *
                             transmittance(world, vertex.interior_towards(light.wi), ray, light.distance);
    return is_black(contribution) ? contribution : contribution * visibility(world, ray, trace.tracer);
}

}  // namespace etendue
