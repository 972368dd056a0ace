#include "transport/whitted.h"

#include "sampling/hash.h"
#include "transport/bodies.h"
#include "transport/direct_light.h"
#include "transport/dispersion.h"
#include "transport/roulette.h"

#include <algorithm>
#include <optional>

namespace etendue {

namespace {

/// Holds a branch of the tree of one sample. All branches have random numbers of their own.
struct Branch {
    EyePath path;
    SampleNumbers numbers;
};

/// Returns light from one chosen light and from the environment. No ray looks for the environment beside these two, of
/// which the first knows nothing of its dimmer parts.
Rgb branch_direct_light(const World& world, const Branch& branch, const Vertex& vertex) {
    const SampleNumbers& numbers = branch.numbers;
    const std::uint32_t alpha_key = shadow_alpha_key(numbers.bits(kBranchAlpha), 0);
    const auto contribution = [&](const LightSample& light, float scale) {
        return light_contribution(world, vertex, branch.path.throughput * vertex.wavelength.weight, light,
                                  vertex.evaluate(light.wi).f_cos, scale,
                                  {branch.path.ray.time, alpha_key, branch.path.tracer});
    };
    Rgb found;
    if (world.traits().has_sampled_lights) {
        const ChosenLight chosen = world.lights().sample(
            vertex.position, {numbers.pair(kBranchLightChoice), numbers.pair(kBranchLightTriangle),
                              numbers.pair(kBranchLightDirection)});
        const LightSample& light = chosen.sample;
        const bool is_environment = chosen.light == world.environment().light();
        if (!is_black(light.radiance))
            found += contribution(
                light, light_sample_scale(
                           chosen, is_environment ? world.environment().emission_pdf_solid_angle(light.wi) : 0.0f));
    }
    if (!world.traits().has_environment) return found;
    const LightSample light =
        world.environment().sample_all(vertex.position, numbers.pair(kBranchEnvironmentDirection));
    if (is_black(light.radiance)) return found;
    const float chosen_pdf = chosen_environment_pdf(world, vertex.position, light.wi);
    return found + contribution(light, light_sample_scale({light, 1.0f, world.environment().light()}, chosen_pdf));
}

/// Returns the branch that grows from `branch` as its child number `child`, without a way yet.
Branch grow(const Branch& branch, std::uint32_t child) {
    Branch next = branch;
    next.numbers.key.pixel_seed = branch_seed(branch.numbers.key.pixel_seed, child);
    ++next.path.rays;
    return next;
}

Branch go_straight_on(const Branch& branch, const Vertex& vertex) {
    Branch next = grow(branch, 0);
    pass(next.path, vertex, next.numbers.bits(kBranchAlpha));
    return next;
}

Branch grow_along(const World& world, const Branch& branch, const Vertex& vertex, const BsdfSample& delta,
                  std::uint32_t child) {
    Branch next = grow(branch, child);
    const Scattering scattering = vertex.scattering();
    if (vertex.chooses_wavelength && mirrors_all_wavelengths(scattering, delta)) {
        next.path.throughput *= world.spectral_response().mean(
            vertex.wavelength, [&](float nm) { return mirrored_share(scattering, vertex.crossing->relative_ior(nm)); });
    } else {
        next.path.throughput *= delta.weight * vertex.wavelength.weight;
        next.path.wavelength_nm = vertex.wavelength.nm;
    }
    leave(world, next.path, vertex, delta, next.numbers.bits(kBranchAlpha));
    return next;
}

/// Returns what a branch of little light stands for, which is followed as rarely; nothing if it is not.
std::optional<Branch> survivor(Branch branch) {
    EyePath& path = branch.path;
    const float chance = branch_survival(max_component(path.throughput) * path.eta_scale, path.rays);
    if (chance >= 1.0f) return branch;
    if (to_unit_float(branch.numbers.bits(kBranchEnd)) >= chance) return {};
    path.throughput *= 1.0f / chance;
    return branch;
}

/// Follows all branches of the tree of one sample.
struct Tree {
    const World& world;
    const PathLengths& lengths;
    EyeLight found{};

    /// Finds the light that comes to the eye along `branch` and all that grows from it.
    void follow(Branch branch);
    void follow_survivor(const Branch& branch) {
        if (const std::optional<Branch> followed = survivor(branch)) follow(*followed);
    }
};

void Tree::follow(Branch branch) {
    EyePath& path = branch.path;
    const Hit hit = nearest_hit(world, path);
    const auto add_met_light = [&](const Vertex& vertex) {
        if (path.edges >= lengths.min_depth)
            (path.is_seen() ? found.seen : found.scattered) += met_light(world, path, vertex);
    };
    if (!hit.valid()) {
        if (path.is_seen() && !(world.traits().has_environment && world.traits().environment_visible_to_camera))
            found.alpha = 0.0f;
        add_met_light(environment_vertex(path.ray.direction));
        return;
    }
    // What scatters on the way is lost like what is absorbed.
    path.throughput *= transmittance(world, path.interior, hit.t);
    const Vertex vertex = surface_vertex(world, path.ray, path.cone, path.interior, hit, path.wavelength_nm,
                                         branch.numbers.pair(kBranchWavelength).x);
    add_met_light(vertex);
    if (vertex.kind == Vertex::Kind::Boundary) follow_survivor(go_straight_on(branch, vertex));
    if (vertex.kind != Vertex::Kind::Surface) return;

    const bool ends_here = path.edges >= lengths.max_depth;
    if (!ends_here && vertex.has_non_delta() && path.edges + 1 >= lengths.min_depth)
        found.scattered += branch_direct_light(world, branch, vertex);
    std::uint32_t child = 0;
    for (const BsdfSample& delta : vertex.scattering().deltas()) {
        // What goes straight through a pane has no vertex there.
        const bool passes = vertex.surface.material->is_pane && delta.is_transmission;
        if (ends_here && !passes) continue;
        Branch next = grow_along(world, branch, vertex, delta, child++);
        next.path.edges += passes ? 0 : 1;
        follow_survivor(next);
    }
}

}  // namespace

EyeLight whitted_light(const World& world, const EyeSample& sample, const IntegratorSettings& settings) {
    Tree tree{world, settings.lengths};
    tree.follow({begin_at_eye(world, sample), sample.numbers});
    return tree.found;
}

}  // namespace etendue
