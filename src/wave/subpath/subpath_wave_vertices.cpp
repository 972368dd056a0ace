// Where subpaths leave their vertices.
#include "transport/bodies.h"
#include "transport/subpath.h"
#include "wave/subpath/subpath_wave.h"

namespace etendue {

bool SubpathWave::make_vertex(const SubpathJob& job, std::size_t i, ShadedSubpath& path) {
    SubpathState& state = states_[i];
    Ray& ray = rays_[i];
    const SurfacePoint& point = path.point;
    if (path.crossing && path.crossing->is_hidden) {
        // No connection passes a boundary.
        state.departing.is_connectible = false;
        state.is_direct = false;
        interiors_[i] = beyond(*path.crossing, point, ray.direction);
        ray.origin = offset_origin(point.position, point.geometric_normal, point.clearance, ray.direction);
        goes_on_[static_cast<std::size_t>(&path - block_.data())] = true;
        return false;
    }
    if (point.material->unlit) {
        end_path(job, i, PathEnding::Unlit);
        return false;
    }
    path.ends_here = state.edges >= job.lengths.max_depth;
    if (path.ends_here && !point.material->is_pane) {
        end_path(job, i, PathEnding::TooLong);
        return false;
    }
    const World& world = job.world;
    const std::optional<Crossing>& crossing = path.crossing;
    float relative_ior = 0.0f;
    if (crossing) {
        state.is_dispersed = state.is_dispersed || crossing->disperses();
        relative_ior = crossing->relative_ior(state.is_dispersed ? job.wavelength(state.slot).nm : 0.0f);
    }
    path.vertex = static_cast<std::uint32_t>(vertices_.size());
    PathVertex& vertex = store(state);
    vertex.wo = -ray.direction;
    vertex.label = words_.label(world, point);
    vertex.densities = path.arrived;
    vertex.next_edges = state.edges + 1;
    place(world, path, relative_ior, vertex);
    if (vertex.is_connectible && !path.ends_here) {
        vertex.merges = merge_at(job.mis(), state.departing, vertex.position, path.arrived);
        vertex.densities = path.arrived;
    }
    if (world.traits().has_bodies) {
        vertex.outside = world.media().within(crossing ? crossing->outside : interiors_[i]);
        vertex.inside = crossing ? world.media().within(crossing->inside) : vertex.outside;
    }
    if (vertex.is_connectible && !path.ends_here) list_connectible(state, state.edges + 1);
    if (path.plain != nullptr) {
        if (make_matte_end(job, path, vertex))
            vertex.matte = path.plain;
        else
            vertex.surface.emplace(*path.plain, lanes_.surface(path.lane));
    }
    if (end_ == SubpathEnd::AtEye || state.edges + edges_to_connect(world) <= job.lengths.max_depth) return true;
    path.ends_here = true;
    if (point.material->is_pane) return true;
    end_path(job, i, PathEnding::TooLong);
    return false;
}

void SubpathWave::place(const World& world, const ShadedSubpath& path, float relative_ior, PathVertex& vertex) {
    if (path.plain != nullptr) {
        vertex.position = lanes_.position[path.lane];
        vertex.geometric_normal = lanes_.geometric_normal[path.lane];
        vertex.clearance = lanes_.clearance[path.lane];
        return;
    }
    const SurfacePoint& point = path.point;
    vertex.position = point.position;
    vertex.geometric_normal = point.geometric_normal;
    vertex.clearance = point.clearance;
    if (bsdf_count_ == bsdfs_.size()) bsdfs_.emplace_back();
    Bsdf& storage = bsdfs_[bsdf_count_];
    const Bsdf& bsdf = world.materials().bsdf(point, vertex.wo, relative_ior, storage);
    if (&bsdf == &storage) ++bsdf_count_;
    vertex.surface.emplace(bsdf, point.shading, point.geometric_normal, vertex.wo);
    vertex.is_connectible = vertex.surface->has_non_delta();
}

bool SubpathWave::make_matte_end(const SubpathJob& job, const ShadedSubpath& path, const PathVertex& vertex) {
    if (!makes_matte_ends_ || vertex.outside != nullptr || vertex.is_dispersed) return false;
    // What floats still hold when the other end's density comes to it; anything else is connected in double precision.
    constexpr double kSmallest = 1e-30, kLargest = 1e30;
    const double fewer = path.arrived.fewer(job.raised, static_cast<double>(lanes_.reverse_pdf[path.lane]));
    if (!((fewer > kSmallest && fewer < kLargest) || fewer == 0.0)) return false;
    ends_[path.lane] = path.vertex;
    lanes_.end_fewer.set(path.lane, static_cast<float>(fewer));
    return true;
}

void SubpathWave::store_matte_ends() {
    std::array<MatteEnd*, kBlock> ends;
    for (std::size_t lane = 0; lane < surfaces_; ++lane)
        ends[lane] = ends_[lane] == PathVertex::kNoVertex ? nullptr : &matte_ends_[ends_[lane]];
    lanes_.store_ends(std::span(ends).first(surfaces_));
}

PathVertex& SubpathWave::store(SubpathState& state) {
    PathVertex& vertex = vertices_.emplace_back();
    if (makes_matte_ends_) matte_ends_.emplace_back();
    vertex.throughput = state.throughput;
    vertex.words = state.words;
    vertex.slot = state.slot;
    vertex.previous = state.last_vertex;
    vertex.index = state.index;
    vertex.is_dispersed = state.is_dispersed;
    vertex.is_reached_directly = state.is_direct;
    vertex.is_seen_directly = state.only_delta;
    state.last_vertex = static_cast<std::uint32_t>(vertices_.size() - 1);
    state.is_direct = true;
    return vertex;
}

void SubpathWave::list_connectible(const SubpathState& state, int next_edges) {
    connectible_vertices_.push_back({static_cast<std::uint32_t>(vertices_.size() - 1), state.slot, state.index,
                                     next_edges, state.only_delta, state.is_dispersed});
}

const PathVertex& SubpathWave::whole(std::uint32_t index) {
    PathVertex& vertex = vertices_[index];
    if (vertex.matte != nullptr && !vertex.surface) {
        const MatteEnd& end = matte_ends_[index];
        vertex.surface.emplace(*vertex.matte, Frame::from_normal(end.normal), end.geometric_normal, vertex.wo);
    }
    return vertex;
}

WordRange SubpathWave::words_after(const PathVertex& vertex, const Vec3f& w) {
    words_.shrink_to(words_of_vertices_);
    return end_ == SubpathEnd::AtEye
               ? words_.scatter_from_eye(vertex.words, vertex.event(w, TransportMode::Radiance))
               : words_.scatter_from_light(vertex.words, vertex.event(w, TransportMode::Importance));
}

}  // namespace etendue
