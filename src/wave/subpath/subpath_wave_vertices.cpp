// Where subpaths leave their vertices.
#include "transport/bodies.h"
#include "transport/subpath.h"
#include "wave/subpath/subpath_wave.h"

namespace etendue {

void SubpathWave::pass_hidden(std::size_t i, const ShadedSubpath& path) {
    const SurfacePoint& point = path.point;
    // Connections pass none but clear boundaries.
    if (!point.material->is_clear) states_[i].pass_hidden();
    Ray& ray = rays_[i];
    interiors_[i] = beyond(*path.crossing, point, ray.direction);
    ray.origin = offset_origin(point.position, point.geometric_normal, point.clearance, ray.direction);
}

bool SubpathWave::make_vertex(const SubpathJob& job, std::size_t first, std::size_t k) {
    const std::size_t i = first + k;
    ShadedSubpath& path = block_[k];
    SubpathState& state = states_[i];
    const SurfacePoint& point = path.point;
    if (path.crossing && path.crossing->is_covered) {
        pass_hidden(i, path);
        goes_on_[k] = true;
        return false;
    }
    if (point.material->unlit) {
        end_path(job, i, PathEnding::Unlit);
        return false;
    }
    path.ends_here = state.edges >= job.lengths.max_depth;
    if (path.ends_here && !point.material->is_clear) {
        end_path(job, i, PathEnding::TooLong);
        return false;
    }
    const World& world = job.world();
    const std::optional<Crossing>& crossing = path.crossing;
    float relative_ior = 0.0f;
    if (crossing) {
        state.is_dispersed = state.is_dispersed || crossing->disperses();
        relative_ior = crossing->relative_ior(state.is_dispersed ? job.wavelength(state.slot).nm : 0.0f);
    }
    path.vertex = static_cast<std::uint32_t>(vertices_.all().size());
    PathVertex& vertex = vertices_.store(state);
    vertex.wo = -rays_[i].direction;
    vertex.label = vertices_.words().label(world, point);
    vertex.densities = path.arrived;
    vertex.next_edges = state.edges + 1;
    if (path.plain == nullptr) {
        vertices_.place(world, point, relative_ior, vertex);
    } else {
        vertex.position = lanes_.position[path.lane];
        vertex.geometric_normal = lanes_.geometric_normal[path.lane];
        vertex.clearance = lanes_.clearance[path.lane];
    }
    if (vertex.is_connectible && !path.ends_here) {
        const bool merges = merges_at(job.mis.merging.at, {end_, state.index, state.only_deltas, state.is_after_delta,
                                                           vertex.is_reached_directly});
        if (merges) {
            vertex.merging = merge_place(world, hits_[i], *point.material);
            count_merge(job.mis, end_, vertex.position, vertex.merging.opacity, path.arrived);
            vertex.densities = path.arrived;
        }
    }
    if (world.traits().has_bodies) {
        vertex.outside = world.media().within(crossing ? crossing->outside : interiors_[i]);
        vertex.inside = crossing ? world.media().within(crossing->inside) : vertex.outside;
    }
    if (world.traits().has_clear_bodies)
        vertices_.keep_interiors(
            {crossing ? crossing->outside : interiors_[i], crossing ? crossing->inside : interiors_[i]});
    const double merged = path.plain != nullptr
                              ? path.arrived.merged(job.mis.raised, static_cast<double>(lanes_.reverse_pdf[path.lane]))
                              : 0.0;
    if (vertex.is_connectible && !path.ends_here)
        vertices_.list_connectible(state, state.edges + 1, static_cast<float>(merged));
    if (path.plain != nullptr) {
        if (make_diffuse_end(job, path, vertex, merged))
            vertex.diffuse = path.plain;
        else
            vertex.surface.emplace(*path.plain, lanes_.surface(path.lane));
    }
    if (end_ == SubpathEnd::AtEye || state.edges + edges_to_connect(world) <= job.lengths.max_depth) return true;
    path.ends_here = true;
    if (point.material->is_clear) return true;
    end_path(job, i, PathEnding::TooLong);
    return false;
}

bool SubpathWave::make_diffuse_end(const SubpathJob& job, const ShadedSubpath& path, const PathVertex& vertex,
                                   double merged) {
    if (!makes_diffuse_ends_ || vertex.outside != nullptr || vertex.is_dispersed ||
        job.world().traits().has_clear_bodies)
        return false;
    // What floats still hold when the other end's density comes to it; anything else is connected in double precision.
    constexpr double kSmallest = 1e-30, kLargest = 1e30;
    const double fewer = path.arrived.fewer(job.mis.raised, static_cast<double>(lanes_.reverse_pdf[path.lane]));
    for (const double density : {fewer, merged})
        if (!((density > kSmallest && density < kLargest) || density == 0.0)) return false;
    ends_[path.lane] = path.vertex;
    lanes_.end_fewer.set(path.lane, static_cast<float>(fewer));
    return true;
}

void SubpathWave::store_diffuse_ends() {
    std::array<DiffuseEnd*, kBlockLanes> ends;
    for (std::size_t lane = 0; lane < surfaces_; ++lane)
        ends[lane] = ends_[lane] == PathVertex::kNoVertex ? nullptr : &vertices_.diffuse_end_at(ends_[lane]);
    lanes_.store_ends(std::span(ends).first(surfaces_));
}

}  // namespace etendue
