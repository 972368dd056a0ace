#include "transport/whitted.h"

#include "transport/delta_tree.h"
#include "transport/direct_light.h"
#include "transport/shadow_catcher.h"

namespace etendue {

namespace {

/// Returns light from one chosen light and from the environment. No ray looks for the environment beside these two, of
/// which the first knows nothing of its dimmer parts.
Rgb branch_direct_light(const World& world, const DeltaBranch& branch, const Vertex& vertex) {
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
            vertex.position,
            {numbers.pair(kBranchLightChoice), numbers.pair(kBranchLightTriangle), numbers.pair(kBranchLightDirection)},
            branch.path.ray.time);
        const LightSample& light = chosen.sample;
        const bool is_environment = chosen.light == world.environment().light();
        if (!is_black(light.radiance))
            found += contribution(
                light, light_sample_scale(
                           chosen, is_environment ? world.environment().emission_pdf_solid_angle(chosen.light, light.wi)
                                                  : 0.0f));
    }
    if (!world.traits().has_environment) return found;
    const LightSample light =
        world.environment().sample_all(vertex.position, numbers.pair(kBranchEnvironmentDirection));
    if (is_black(light.radiance)) return found;
    const std::uint32_t environment = world.environment().light();
    const float chosen_pdf = chosen_pdf_from_afar(world, vertex.position, environment, light.wi);
    return found + contribution(light, light_sample_scale({light, 1.0f, environment}, chosen_pdf));
}

/// Adds the light of all branches of the tree of one sample.
struct WhittedLight {
    struct NoState {};

    const World& world;
    const PathLengths& lengths;
    EyeLight found{};

    void visit(const DeltaBranch& branch, NoState, const Vertex& vertex) {
        const EyePath& path = branch.path;
        if (is_replaced(path, vertex)) return see_in_place(branch, vertex);
        if (vertex.kind == Vertex::Kind::Environment && path.is_seen()) return see_environment(path);
        if (lengths.is_long_enough(path.edges))
            (path.is_seen() ? found.seen : found.scattered) += met_light(world, path, vertex);
        if (vertex.kind == Vertex::Kind::Surface && lengths.keeps(path.edges + 1) && vertex.has_non_delta())
            found.scattered += branch_direct_light(world, branch, vertex);
    }
    /// Adds what lies behind the whole scene: the environment, or nothing where the camera does not see that.
    void see_environment(const EyePath& path) {
        if (world.environment().met(true).empty())
            found.alpha += alpha_over_background(path.throughput) - 1.0f;
        else if (lengths.is_long_enough(path.edges))
            found.seen += met_light(world, path, environment_vertex(path.ray.direction));
    }
    void see_in_place(const DeltaBranch& branch, const Vertex& vertex) {
        EyePath path = branch.path;
        const SeenInPlace seen =
            seen_in_place(world, vertex.surface, path.ray, path.interior, branch.numbers, path.tracer);
        if (seen.is_hole) {
            found.alpha += alpha_over_background(path.throughput) - 1.0f;
            return;
        }
        path.throughput *= seen.passed;
        see_environment(path);
    }
    [[nodiscard]] static NoState after(NoState state, const Vertex&, const BsdfSample&) { return state; }
};

}  // namespace

EyeLight whitted_light(const World& world, const EyeSample& sample, const IntegratorSettings& settings) {
    WhittedLight light{world, settings.lengths};
    follow_deltas(world, {begin_at_eye(world, sample), sample.numbers}, WhittedLight::NoState{},
                  settings.lengths.max_depth, light);
    return light.found;
}

}  // namespace etendue
