#include "wave/subpath/subpath_vertices.h"

#include "core/vector_bytes.h"
#include "transport/subpath.h"

namespace etendue {

void SubpathVertices::reset(const AovSet* aovs) {
    vertices_.clear();
    interiors_.clear();
    connectible_.clear();
    diffuse_ends_.clear();
    words_.reset(aovs);
    bsdf_count_ = 0;
}

const PathVertex& SubpathVertices::whole(std::uint32_t place) {
    PathVertex& vertex = vertices_[place];
    if (vertex.diffuse != nullptr && !vertex.surface) {
        const DiffuseEnd& end = diffuse_ends_[place];
        vertex.surface.emplace(*vertex.diffuse, Frame::from_normal(end.normal), end.geometric_normal, vertex.wo);
    }
    return vertex;
}

Rgb SubpathVertices::transmittance(const World& world, const PathVertex& vertex, const Ray& ray, float distance,
                                   RayEnds ends) const {
    if (interiors_.empty()) {
        const HomogeneousMedium* medium = vertex.medium(ray.direction);
        return medium != nullptr ? medium->transmittance(distance) : Rgb(1.0f);
    }
    const SideInteriors& sides = interiors_[static_cast<std::size_t>(&vertex - vertices_.data())];
    const bool is_outside = dot(ray.direction, vertex.geometric_normal) > 0.0f;
    return world.media().transmittance(is_outside ? sides.outside : sides.inside, ray, ends);
}

WordRange SubpathVertices::words_after(const PathVertex& vertex, const Vec3f& w) {
    words_.shrink_to(words_of_vertices_);
    return scatter(vertex.words, vertex.event(w, mode_of(end_)));
}

PathVertex& SubpathVertices::store(SubpathState& state) {
    PathVertex& vertex = vertices_.emplace_back();
    if (makes_diffuse_ends_) diffuse_ends_.emplace_back();
    vertex.throughput = state.throughput;
    vertex.words = state.words;
    vertex.slot = state.slot;
    vertex.index = state.index;
    vertex.is_dispersed = state.is_dispersed;
    vertex.is_reached_directly = state.is_direct;
    vertex.is_seen_directly = state.only_deltas;
    vertex.is_after_delta = state.is_after_delta;
    state.is_direct = true;
    return vertex;
}

void SubpathVertices::list_connectible(const SubpathState& state, int next_edges, float merged, bool is_in_dense) {
    connectible_.push_back({static_cast<std::uint32_t>(vertices_.size() - 1), state.slot, state.index, next_edges,
                            state.only_deltas, state.is_dispersed, state.is_after_delta, is_in_dense, merged});
}

void SubpathVertices::place(const World& world, const SurfacePoint& point, float relative_ior, PathVertex& vertex) {
    vertex.position = point.position;
    vertex.geometric_normal = point.geometric_normal;
    vertex.clearance = point.clearance;
    vertex.lights_camera = point.material->lights_camera();
    if (bsdf_count_ == bsdfs_.size()) bsdfs_.emplace_back();
    Bsdf& storage = bsdfs_[bsdf_count_];
    const Bsdf& bsdf = world.materials().bsdf(point, vertex.wo, relative_ior, storage);
    if (&bsdf == &storage) ++bsdf_count_;
    vertex.surface.emplace(bsdf, point.shading, point.geometric_normal, vertex.wo);
    if (point.material->culls_back) vertex.surface->hide_back(point.geometric_normal);
    vertex.is_connectible = vertex.surface->has_non_delta();
}

std::size_t SubpathVertices::bytes() const {
    return vector_bytes(vertices_, interiors_, connectible_, diffuse_ends_) + bsdfs_.size() * sizeof(Bsdf);
}

}  // namespace etendue
