#include "transport/walk.h"

#include "transport/dispersion.h"
#include "transport/roulette.h"
#include "transport/scattered_cone.h"

#include <span>

namespace etendue {

VertexNumbers::VertexNumbers(const SampleNumbers& numbers, int rays)
    : medium(numbers.pair(body_dimension(rays, kMedium))),
      wavelength(numbers.pair(body_dimension(rays, kWavelength)).x),
      lobe(numbers.pair(bounce_dimension(rays, kChoices)).x),
      direction(numbers.pair(bounce_dimension(rays, kBsdfDirection))),
      roulette(numbers.pair(bounce_dimension(rays, kChoices)).y),
      alpha_key(numbers.bits(bounce_dimension(rays, kAlpha))) {}

EyePath begin_at_eye(const World& world, const EyeSample& sample) {
    return {.ray = sample.ray,
            .cone = sample.cone,
            .interior = world.media().interior_at_camera(sample.ray),
            .tracer = sample.tracer};
}

Hit nearest_hit(const World& world, const Ray& ray, RayEnds ends) {
    Hit hit;
    world.geometry().intersect(std::span(&ray, 1), std::span(&hit, 1), Coherence::Incoherent, QueryForm::Best, ends);
    return hit;
}

Hit nearest_hit(const World& world, const EyePath& path) {
    const auto trace = [&](RayEnds ends) {
        return path.tracer != nullptr ? path.tracer->nearest_hit(path.ray, path.rays, ends)
                                      : nearest_hit(world, path.ray, ends);
    };
    const Hit hit = trace(RayEnds::InScene);
    const bool passes = path.is_seen() && world.materials().is_hidden_from_camera(hit);
    const Hit shown = passes ? trace(RayEnds::AtCamera) : hit;
    return world.traits().clips_far && path.is_seen() ? world.camera().cut_far(path.ray, shown) : shown;
}

Rgb visibility(const World& world, const Ray& ray, SampleTracer* tracer, RayEnds ends) {
    std::uint8_t occluded = kFree;
    if (tracer != nullptr)
        occluded = tracer->occluded(ray);
    else
        world.geometry().occluded(std::span(&ray, 1), std::span(&occluded, 1), QueryForm::Best, ends);
    if (occluded == kOccluded) return {};
    return occluded == kPassesClear ? world.geometry().clear_transmittance(ray, ends) : Rgb(1.0f);
}

void pass(EyePath& path, const Vertex& vertex, std::uint32_t alpha_key) {
    path.ray.origin = vertex.origin_towards(path.ray.direction);
    path.ray.alpha_key = alpha_key;
    path.cone = vertex.cone;
    path.interior = vertex.interior_towards(path.ray.direction);
}

Vertex next_vertex(const World& world, EyePath& path, const VertexNumbers& u) {
    const Hit hit = nearest_hit(world, path);
    // What leaves the scene was in no body, whatever holes in meshes made of its interior.
    if (!hit.has_end()) return environment_vertex(path.ray.direction);
    const ArrivingRay arriving{path.ray, path.interior, hit, path.cone};
    if (const auto vertex = medium_vertex(world, arriving, path.throughput, u.medium)) return *vertex;
    if (!hit.valid()) return environment_vertex(path.ray.direction);
    return surface_vertex(world, arriving, path.wavelength_nm, u.wavelength);
}

bool scatter(const World& world, EyePath& path, const Vertex& vertex, const VertexNumbers& u,
             std::uint32_t light_samples, const IntegratorSettings& settings) {
    if (vertex.kind == Vertex::Kind::Boundary) {
        // Light samples pass none but clear boundaries.
        if (!vertex.surface.material->is_clear) path.last.samples = 0;
        path.last.passed += vertex.distance;
        pass(path, vertex, u.alpha_key);
        return true;
    }
    const BsdfSample sample =
        settings.even_directions ? vertex.sample_evenly(u.lobe, u.direction) : vertex.sample(u.lobe, u.direction);
    if (is_black(sample.weight)) return false;
    const bool is_surface = vertex.kind == Vertex::Kind::Surface;
    if (is_surface && goes_straight_on(*vertex.surface.material, sample)) {
        path.throughput *= sample.weight;
        path.last.passed += vertex.distance;
        pass(path, vertex, u.alpha_key);
        return true;
    }
    if (is_surface && path.edges >= settings.lengths.max_depth) return false;
    path.throughput *= sample.weight;
    if (is_surface) {
        const Wavelength after = wavelength_after(
            vertex.scattering(), vertex.crossing, sample, vertex.wavelength, vertex.chooses_wavelength,
            [&](const auto& share) { return world.spectral_response().mean_over_chance(vertex.wavelength, share); });
        path.throughput *= after.weight;
        path.wavelength_nm = after.nm;
    }
    path.edges += is_surface ? 1 : 0;
    path.only_deltas = path.only_deltas && sample.is_delta;
    path.last = {.receiver = vertex.receiver(),
                 .samples = sample.is_delta ? 0 : light_samples,
                 .pdf_solid_angle = sample.pdf_solid_angle};
    leave(world, path, vertex, sample, u.alpha_key);
    return true;
}

void leave(const World& world, EyePath& path, const Vertex& vertex, const BsdfSample& sample, std::uint32_t alpha_key) {
    path.cone = vertex.kind == Vertex::Kind::Medium ? scatter_cone(vertex.cone, lobe_spread(sample.pdf_solid_angle))
                                                    : scattered_cone(world, vertex.hit, vertex.surface.geometric_normal,
                                                                     path.ray.direction, vertex.cone, sample);
    path.ray.origin = vertex.origin_towards(sample.wi);
    path.ray.direction = sample.wi;
    path.ray.alpha_key = alpha_key;
    path.interior = vertex.interior_towards(sample.wi);
    if (sample.is_transmission) path.roulette_scale *= sample.eta * sample.eta;
}

bool survives_roulette(const World& world, EyePath& path, float u, int roulette_depth) {
    if (path.rays < first_roulette(world, roulette_depth)) return true;
    const float survival = eye_path_survival(max_component(path.throughput) * path.roulette_scale,
                                             most_survival(PathKind::Walk, path.rays));
    path.throughput *= 1.0f / survival;
    return u < survival;
}

}  // namespace etendue
