#include "transport/path.h"

#include "transport/direct_light.h"

namespace etendue {

namespace {

/// Returns how many lights the path samples at `vertex`: none where their light would be on a path too short or too
/// long. A vertex in a medium adds no edge; there, lights are sampled only if shadow rays may reach one: they pass no
/// boundary that bends light.
std::uint32_t light_samples_at(const World& world, const EyePath& path, const Vertex& vertex,
                               const IntegratorSettings& settings) {
    const bool is_medium = vertex.kind == Vertex::Kind::Medium;
    const int edges = path.edges + (is_medium ? 0 : 1);
    const bool samples_lights =
        settings.light_samples > 0 && vertex.has_non_delta() &&
        (is_medium ? world.traits().samples_lights_in_media : world.traits().has_sampled_lights) &&
        settings.lengths.keeps(edges);
    if (!samples_lights) return 0;
    // Next-event splitting, where the eye looks.
    return path.only_deltas ? settings.light_samples : 1;
}

}  // namespace

Rgb path_radiance(const World& world, const EyeSample& sample, const IntegratorSettings& settings) {
    Rgb radiance;
    EyePath path = begin_at_eye(world, sample);
    for (;; ++path.rays) {
        const VertexNumbers u(sample.numbers, path.rays);
        const Vertex vertex = next_vertex(world, path, u);
        // Weighed against the light samples of the vertex before, path.last.
        if (settings.lengths.is_long_enough(path.edges)) radiance += met_light(world, path, vertex);
        if (vertex.kind == Vertex::Kind::Environment || vertex.kind == Vertex::Kind::Unlit) break;

        const std::uint32_t light_samples = light_samples_at(world, path, vertex, settings);
        if (light_samples > 0) radiance += sampled_light(world, path, vertex, sample.numbers, u, light_samples);

        if (!scatter(world, path, vertex, u, light_samples, settings)) break;
        if (!survives_roulette(world, path, u.roulette, settings.lengths.roulette_depth)) break;
    }
    return radiance;
}

}  // namespace etendue
