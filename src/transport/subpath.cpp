#include "transport/subpath.h"

#include "transport/bodies.h"
#include "transport/roulette.h"
#include "world/lit_surface.h"

namespace etendue {

namespace {

/// Returns the densities with which the subpath arrives at `vertex`, where its ray has this cosine.
SubpathDensities densities_at(const SubpathSample& sample, const Subpath& subpath, const Vertex& vertex, float cosine) {
    const Vec3f& position = vertex.position;
    const auto cos_arriving = static_cast<double>(cosine);
    if (subpath.index > 1) {
        const auto squared_distance = static_cast<double>(length_squared(position - subpath.from));
        SubpathDensities arrived =
            subpath.departing.arrive(sample.mis.raised, squared_distance, cos_arriving, vertex.is_in_dense());
        if (subpath.end == SubpathEnd::AtLight && sample.counts_path_tracing_alone) arrived.a = 0.0;
        return arrived;
    }
    if (subpath.end == SubpathEnd::AtLight)
        return arrive_from_light(sample.mis, *subpath.emission, subpath.departing, position, cos_arriving);
    return arrive_from_lens(sample.mis, subpath.departing,
                            sample.world().camera().connect(position, sample.eye.lens, subpath.ray.time), cos_arriving);
}

SubpathVertex make_vertex(const Subpath& subpath, const Vertex& vertex, const SubpathDensities& densities,
                          int next_edges) {
    return {
        vertex, subpath.throughput, densities, subpath.index, next_edges, subpath.is_dispersed, subpath.is_after_delta};
}

/// Sends the subpath on from `vertex`, at which it has arrived with `densities`, along `scattered`.
void depart_from(const SubpathSample& sample, Subpath& subpath, const Vertex& vertex, const SubpathDensities& densities,
                 const BsdfSample& scattered) {
    const float cosine = vertex.cosine(scattered.wi);
    subpath.departing = scattered.is_delta
                            ? depart_by_delta(sample.mis.raised, densities, scattered.reverse_ratio, cosine)
                            : depart(sample.mis.raised, densities, scattered.pdf_solid_angle,
                                     vertex.reverse_pdf(scattered.wi, subpath.mode()), cosine);
    subpath.departing.is_in_dense = vertex.is_in_dense();
    subpath.throughput *= scattered.weight;
    if (subpath.end == SubpathEnd::AtEye && scattered.is_transmission)
        subpath.roulette_scale *= scattered.eta * scattered.eta;
    subpath.only_deltas = subpath.only_deltas && scattered.is_delta;
    subpath.is_after_delta = subpath.is_after_delta || scattered.is_delta;
    subpath.is_direct = true;
    subpath.from = vertex.position;
    ++subpath.index;
    subpath.edges += vertex.kind == Vertex::Kind::Surface ? 1 : 0;
    subpath.ray.origin = vertex.origin_towards(scattered.wi);
    subpath.ray.direction = scattered.wi;
    subpath.interior = vertex.interior_towards(scattered.wi);
}

/// Goes straight on through the boundary of a body that another hides, or a clear surface.
void pass_through(Subpath& subpath, const Vertex& vertex) {
    subpath.ray.origin = vertex.origin_towards(subpath.ray.direction);
    subpath.interior = vertex.interior_towards(subpath.ray.direction);
}

/// Goes on from a surface that the subpath has reached; false if it ends there.
bool scatter_at_surface(const SubpathSample& sample, Subpath& subpath, const Vertex& vertex, SubpathDensities densities,
                        int bounce, std::vector<SubpathVertex>& vertices) {
    // The camera sees something else in the place of the surface.
    if (subpath.end == SubpathEnd::AtEye && subpath.index == kDirectlySeen &&
        vertex.surface.material->seen_as != SeenAs::Surface)
        return false;
    const bool is_clear = vertex.surface.material->is_clear;
    bool ends_here = subpath.edges >= sample.lengths.max_depth;
    if (ends_here && !is_clear) return false;
    subpath.is_dispersed = subpath.is_dispersed || vertex.chooses_wavelength;
    if (vertex.has_non_delta() && !ends_here) {
        MergePlace merging;
        if (merges_at(sample.mis.merging.at,
                      {subpath.end, subpath.index, subpath.only_deltas, subpath.is_after_delta, subpath.is_direct})) {
            merging = merge_place(sample.world(), vertex.hit, *vertex.surface.material);
            count_merge(sample.mis, subpath.end, vertex.position, merging.opacity, densities);
        }
        vertices.push_back(make_vertex(subpath, vertex, densities, subpath.edges + 1));
        vertices.back().merging = merging;
    }
    // A light subpath needs one more edge to the camera, at least.
    if (subpath.end == SubpathEnd::AtLight)
        ends_here = ends_here || subpath.edges + edges_to_connect(sample.world()) > sample.lengths.max_depth;
    const BsdfSample scattered =
        vertex.sample(sample.pair(subpath.end, bounce, SubpathDimension::Choices).x,
                      sample.pair(subpath.end, bounce, SubpathDimension::Scattering), subpath.mode());
    if (is_black(scattered.weight)) return false;
    if (goes_straight_on(*vertex.surface.material, scattered)) {
        subpath.throughput *= scattered.weight;
        pass_through(subpath, vertex);
        return true;
    }
    if (ends_here) return false;
    depart_from(sample, subpath, vertex, densities, scattered);
    return true;
}

bool survives_roulette(const SubpathSample& sample, Subpath& subpath, int bounce, int roulette_depth) {
    if (bounce < first_roulette(sample.world(), roulette_depth)) return true;
    const float share = max_component(subpath.throughput) * subpath.roulette_scale;
    const float most = most_survival(PathKind::Subpath, bounce);
    const float survival =
        subpath.end == SubpathEnd::AtEye ? eye_path_survival(share, most) : light_path_survival(share, most);
    subpath.throughput *= 1.0f / survival;
    return sample.pair(subpath.end, bounce, SubpathDimension::Choices).y < survival;
}

}  // namespace

Subpath begin_subpath_at_eye(const SubpathSample& sample) {
    Subpath subpath;
    subpath.ray = sample.eye.ray;
    subpath.interior = sample.world().media().interior_at_camera(subpath.ray);
    subpath.from = sample.eye.ray.origin;
    return subpath;
}

std::optional<Subpath> begin_subpath_at_light(const SubpathSample& sample) {
    const World& world = sample.world();
    if (!world.traits().has_lights) return {};
    const auto draw = [&](EmissionDimension which) { return sample.eye.numbers.pair(kFirstLightDimension + which); };
    Subpath subpath;
    subpath.end = SubpathEnd::AtLight;
    const Emission emission =
        world.emitters().sample(draw(kEmitterChoice), {draw(kTriangle), draw(kPosition), draw(kDirection)},
                                sample.eye.ray.time, sample.mis.aims);
    subpath.emission = emission;
    subpath.ray = emission.ray;
    subpath.ray.alpha_key = sample.eye.numbers.bits(kFirstLightDimension);
    subpath.throughput = emission.weight;
    subpath.roulette_scale = 1.0f / max_component(emission.weight);
    subpath.from = emission.sample.position;
    subpath.departing = leave_light(sample.mis, emission);
    subpath.interior = interior_at_light(world, emission, emission.ray.direction);
    return subpath;
}

std::vector<SubpathVertex> follow_subpath(const SubpathSample& sample, Subpath subpath, int roulette_depth,
                                          const Arrival& arrive) {
    const World& world = sample.world();
    std::vector<SubpathVertex> vertices;
    for (int bounce = 1;; ++bounce) {
        const bool is_seen = subpath.end == SubpathEnd::AtEye && subpath.index == kDirectlySeen;
        const bool is_among_others = subpath.end == SubpathEnd::AtLight && world.traits().culls_backs;
        Hit hit;
        if (is_among_others) {
            const LitSurface lit = find_lit_surface(world, subpath.ray);
            hit = lit.hit;
            subpath.throughput *= lit.count;
        } else {
            hit = nearest_hit(world, subpath.ray, is_seen ? RayEnds::AtCamera : RayEnds::InScene);
        }
        if (is_seen && world.traits().clips_far) hit = world.camera().cut_far(subpath.ray, hit);
        const ArrivingRay arriving{subpath.ray, subpath.interior, hit};
        const Vec2f u_medium = sample.pair(subpath.end, bounce, SubpathDimension::Medium);
        const auto vertex = hit.has_end() ? medium_vertex(world, arriving, subpath.throughput, u_medium) : std::nullopt;
        if (vertex) {
            if (is_among_others) subpath.throughput *= chance_beyond(world, subpath.ray, vertex->position);
            const SubpathDensities densities = densities_at(sample, subpath, *vertex, 1.0f);
            vertices.push_back(make_vertex(subpath, *vertex, densities, subpath.edges));
            const Vec2f u = sample.pair(subpath.end, bounce, SubpathDimension::Scattering);
            depart_from(sample, subpath, *vertex, densities, vertex->sample(0.0f, u, subpath.mode()));
        } else if (!hit.valid()) {
            if (arrive) arrive(subpath, environment_vertex(subpath.ray.direction), {});
            break;
        } else if (is_among_others && !is_lit(world, hit, subpath.ray.direction)) {
            break;
        } else {
            const float nanometres = subpath.is_dispersed ? sample.wavelength().nm : 0.0f;
            const Vertex surface = surface_vertex(world, arriving, nanometres, sample.wavelength_number());
            const float cosine = abs_dot(subpath.ray.direction, surface.surface.geometric_normal);
            const SubpathDensities densities = densities_at(sample, subpath, surface, cosine);
            if (arrive) arrive(subpath, surface, densities);
            if (surface.kind == Vertex::Kind::Unlit) break;
            if (surface.kind == Vertex::Kind::Boundary) {
                // Connections pass none but clear boundaries.
                if (!surface.surface.material->is_clear) subpath.pass_hidden();
                pass_through(subpath, surface);
            } else if (!scatter_at_surface(sample, subpath, surface, densities, bounce, vertices)) {
                break;
            }
        }
        subpath.ray.alpha_key =
            sample.eye.numbers.bits(subpath_dimension(subpath.end, bounce, SubpathDimension::Alpha));
        if (!survives_roulette(sample, subpath, bounce, roulette_depth)) break;
    }
    return vertices;
}

}  // namespace etendue
