#include "transport/vertex.h"

#include "bsdf/gloss.h"

namespace etendue {

bool Vertex::has_non_delta() const {
    return kind == Kind::Medium || (kind == Kind::Surface && etendue::has_non_delta(bsdf));
}

BsdfValue Vertex::evaluate(const Vec3f& wi, TransportMode mode) const {
    if (kind == Kind::Surface) return scattering().evaluate(wi, mode);
    const float phase = medium->phase.pdf_solid_angle(wo, wi);
    return {Rgb(phase), phase};
}

Scattering::TwoWayValue Vertex::evaluate_both_ways(const Vec3f& wi, TransportMode mode) const {
    if (kind == Kind::Surface) return scattering().evaluate_both_ways(wi, mode);
    // Forwards and backwards a phase function has one density.
    const float phase = medium->phase.pdf_solid_angle(wo, wi);
    return {Rgb(phase), phase, phase};
}

float Vertex::reverse_pdf(const Vec3f& wi, TransportMode mode) const {
    return kind == Kind::Surface ? scattering().reverse_pdf_solid_angle(wi, mode)
                                 : medium->phase.pdf_solid_angle(wo, wi);
}

float Vertex::cosine(const Vec3f& w) const {
    return kind == Kind::Surface ? abs_dot(w, surface.geometric_normal) : 1.0f;
}

BsdfSample Vertex::sample_evenly(float u_lobe, Vec2f u) const {
    return kind == Kind::Surface ? scattering().sample_evenly(u_lobe, u) : sample(u_lobe, u);
}

BsdfSample Vertex::sample(float u_lobe, Vec2f u, TransportMode mode) const {
    if (kind == Kind::Surface) return scattering().sample(u_lobe, u, mode);
    BsdfSample sample;
    sample.wi = medium->phase.sample(wo, u);
    sample.pdf_solid_angle = medium->phase.pdf_solid_angle(wo, sample.wi);
    sample.weight = Rgb(1.0f);
    return sample;
}

Vec3f Vertex::origin_towards(const Vec3f& wi) const {
    if (kind == Kind::Medium) return position;
    return offset_origin(surface.position, surface.geometric_normal, surface.clearance, wi);
}

const Interior& Vertex::interior_towards(const Vec3f& wi) const {
    return crossing ? beyond(*crossing, surface, wi) : interior;
}

LightReceiver Vertex::receiver() const {
    return kind == Kind::Surface ? light_receiver(position, scattering()) : LightReceiver(position);
}

LightReceiver light_receiver(const Vec3f& position, const Scattering& scattering) {
    LightReceiver receiver(position);
    if (!only_reflects(scattering.bsdf())) return receiver;
    const Gloss gloss = gloss_of(scattering.bsdf(), scattering.wo_local().z);
    receiver.normal = scattering.normal();
    receiver.wo = scattering.wo();
    receiver.glossy = gloss.share;
    receiver.alpha = gloss.alpha;
    return receiver;
}

std::optional<Vertex> medium_vertex(const World& world, const ArrivingRay& arriving, Rgb& throughput, Vec2f u) {
    const auto& [ray, interior, hit, cone] = arriving;
    const HomogeneousMedium* const medium = world.media().within(interior);
    if (medium == nullptr) return {};
    const MediumSample sample = medium->sample(throughput, hit.t, u);
    throughput *= sample.weight;
    if (!sample.scatters) return {};
    Vertex vertex;
    vertex.kind = Vertex::Kind::Medium;
    vertex.wo = -ray.direction;
    vertex.position = ray.origin + ray.direction * sample.distance;
    vertex.distance = sample.distance;
    vertex.cone = cone.at(sample.distance);
    vertex.interior = interior;
    vertex.medium = medium;
    return vertex;
}

Vertex surface_vertex(const World& world, const ArrivingRay& arriving, float nanometres, float u_wavelength) {
    const auto& [ray, interior, hit, cone] = arriving;
    Vertex vertex;
    vertex.wo = -ray.direction;
    vertex.distance = hit.t;
    vertex.cone = cone.at(hit.t);
    vertex.interior = interior;
    vertex.hit = hit;
    vertex.surface = world.geometry().surface_point(hit, ray, cone);
    SurfacePoint& point = vertex.surface;
    vertex.crossing = crossing_at(world, point, arriving);
    vertex.position = point.position;
    vertex.kind = vertex.crossing && vertex.crossing->is_covered ? Vertex::Kind::Boundary
                  : point.material->unlit                        ? Vertex::Kind::Unlit
                                                                 : Vertex::Kind::Surface;
    if (vertex.kind != Vertex::Kind::Surface) return vertex;
    // Where the index depends on the wavelength, a path of all of them takes one to go on with.
    vertex.wavelength = {nanometres, Rgb(1.0f)};
    vertex.chooses_wavelength = vertex.crossing && vertex.crossing->disperses() && nanometres == 0.0f;
    if (vertex.chooses_wavelength) vertex.wavelength = world.spectral_response().sample(u_wavelength);
    Bsdf storage;
    vertex.bsdf = world.materials().bsdf(
        point, vertex.wo, vertex.crossing ? vertex.crossing->relative_ior(vertex.wavelength.nm) : 0.0f, storage);
    return vertex;
}

}  // namespace etendue
