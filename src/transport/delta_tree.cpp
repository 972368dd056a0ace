#include "transport/delta_tree.h"

#include "sampling/hash.h"
#include "transport/bodies.h"
#include "transport/dispersion.h"
#include "transport/roulette.h"

namespace etendue {

namespace {

/// Returns the branch that grows from `branch` as its child number `child`, without a way yet.
DeltaBranch grow(const DeltaBranch& branch, std::uint32_t child) {
    DeltaBranch next = branch;
    next.numbers.key.pixel_seed = branch_seed(branch.numbers.key.pixel_seed, child);
    ++next.path.rays;
    return next;
}

}  // namespace

DeltaBranch go_straight_on(const DeltaBranch& branch, const Vertex& vertex) {
    DeltaBranch next = grow(branch, 0);
    pass(next.path, vertex, next.numbers.bits(kBranchAlpha));
    return next;
}

DeltaBranch grow_along(const World& world, const DeltaBranch& branch, const Vertex& vertex, const BsdfSample& delta,
                       std::uint32_t child) {
    DeltaBranch next = grow(branch, child);
    const Wavelength after =
        wavelength_after(vertex.scattering(), vertex.crossing, delta, vertex.wavelength, vertex.chooses_wavelength,
                         [&](const auto& share) { return world.spectral_response().mean(vertex.wavelength, share); });
    // The mean of all wavelengths has the share that is mirrored, which is the weight of the delta for one of them.
    const bool is_of_all = vertex.chooses_wavelength && after.nm == 0.0f;
    next.path.throughput *= is_of_all ? after.weight : delta.weight * after.weight;
    next.path.wavelength_nm = after.nm;
    leave(world, next.path, vertex, delta, next.numbers.bits(kBranchAlpha));
    return next;
}

std::optional<DeltaBranch> survivor(DeltaBranch branch) {
    EyePath& path = branch.path;
    const float chance = branch_survival(max_component(path.throughput) * path.roulette_scale, path.rays);
    if (chance >= 1.0f) return branch;
    if (to_unit_float(branch.numbers.bits(kBranchEnd)) >= chance) return {};
    path.throughput *= 1.0f / chance;
    return branch;
}

Vertex next_vertex(const World& world, DeltaBranch& branch) {
    EyePath& path = branch.path;
    const Hit hit = nearest_hit(world, path);
    if (hit.has_end()) path.throughput *= transmittance(world, path.interior, hit.t);
    if (!hit.valid()) return environment_vertex(path.ray.direction);
    return surface_vertex(world, {path.ray, path.interior, hit, path.cone}, path.wavelength_nm,
                          branch.numbers.pair(kBranchWavelength).x);
}

}  // namespace etendue
