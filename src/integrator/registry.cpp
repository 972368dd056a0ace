// All integrators, in the order in which --help lists them.
#include "integrator/bdpt/bdpt_integrator.h"
#include "integrator/debug/albedo_integrator.h"
#include "integrator/debug/normals_integrator.h"
#include "integrator/integrator.h"
#include "integrator/light/light_integrator.h"
#include "integrator/path/path_integrator.h"
#include "integrator/whitted/whitted_integrator.h"

#include <algorithm>

namespace etendue {

namespace {

/// Camera, surface, light.
constexpr int kDirectPath = 2;

std::unique_ptr<const Integrator> make_path(const IntegratorOptions& options) {
    return std::make_unique<PathIntegrator>(
        PathOptions{.lengths = options.lengths, .light_samples = options.light_samples});
}

std::unique_ptr<const Integrator> make_direct(const IntegratorOptions& options) {
    PathLengths one_bounce = options.lengths;
    one_bounce.max_depth = std::min(one_bounce.max_depth, kDirectPath);
    return std::make_unique<PathIntegrator>(PathOptions{.lengths = one_bounce, .light_samples = options.light_samples},
                                            true);
}

std::unique_ptr<const Integrator> make_naive(const IntegratorOptions& options) {
    return std::make_unique<PathIntegrator>(PathOptions{.lengths = options.lengths, .sample_lights = false});
}

std::unique_ptr<const Integrator> make_light(const IntegratorOptions& options) {
    return std::make_unique<LightIntegrator>(options.lengths);
}

std::unique_ptr<const Integrator> make_bdpt(const IntegratorOptions& options) {
    return std::make_unique<BdptIntegrator>(BdptOptions{.lengths = options.lengths,
                                                        .heuristic = options.heuristic,
                                                        .only = options.strategy,
                                                        .weighted = options.weighted,
                                                        .cached_connections = options.cached_connections});
}

std::unique_ptr<const Integrator> make_whitted(const IntegratorOptions& options) {
    return std::make_unique<WhittedIntegrator>(options.lengths);
}

std::unique_ptr<const Integrator> make_normals(const IntegratorOptions&) {
    return std::make_unique<NormalsIntegrator>();
}

std::unique_ptr<const Integrator> make_albedo(const IntegratorOptions&) {
    return std::make_unique<AlbedoIntegrator>();
}

constexpr IntegratorEntry kRegistry[] = {
    {.name = "path",
     .summary = "eye paths with light sampling, combined by MIS",
     .make = make_path,
     .splits_light_samples = true},
    {.name = "direct",
     .summary = "path, one bounce only",
     .make = make_direct,
     .longest_path = kDirectPath,
     .splits_light_samples = true},
    {"naive", "eye paths that find lights by chance", make_naive},
    {"light", "paths from the lights, connected to the camera", make_light},
    {.name = "bdpt",
     .summary = "eye and light paths, connected in every way, combined by MIS",
     .make = make_bdpt,
     .has_strategies = true},
    {.name = "whitted",
     .summary = "mirrored and refracted rays, direct light, and no more",
     .make = make_whitted,
     .has_expressions = false},
    {.name = "normals",
     .summary = "shading normals, for debugging",
     .make = make_normals,
     .has_expressions = false,
     .shows_light = false},
    {.name = "albedo",
     .summary = "scattered share of light, for debugging",
     .make = make_albedo,
     .has_expressions = false,
     .shows_light = false},
};

}  // namespace

std::span<const IntegratorEntry> integrator_registry() {
    return kRegistry;
}

const IntegratorEntry* find_integrator(std::string_view name) {
    const auto* const found = std::ranges::find(kRegistry, name, &IntegratorEntry::name);
    return found != std::ranges::end(kRegistry) ? found : nullptr;
}

std::unique_ptr<const Integrator> make_integrator(std::string_view name, const IntegratorOptions& options) {
    const IntegratorEntry* const entry = find_integrator(name);
    return entry != nullptr ? entry->make(options) : nullptr;
}

}  // namespace etendue
