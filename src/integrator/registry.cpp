// All integrators, in the order in which --help lists them.
#include "integrator/bdpt/bdpt_integrator.h"
#include "integrator/integrator.h"
#include "integrator/light/light_integrator.h"
#include "integrator/path/path_integrator.h"
#include "integrator/scalar_integrators.h"

#include <algorithm>
#include <utility>

namespace etendue {

namespace {

/// Camera, surface, light.
constexpr int kDirectPath = 2;

template <typename AnyIntegrator>
std::unique_ptr<const Integrator> make(const IntegratorSettings& settings) {
    return std::make_unique<AnyIntegrator>(settings);
}

std::unique_ptr<const Integrator> make_direct(IntegratorSettings settings) {
    settings.lengths.max_depth = std::min(settings.lengths.max_depth, kDirectPath);
    return std::make_unique<PathIntegrator>(settings, true);
}

std::unique_ptr<const Integrator> make_naive(IntegratorSettings settings) {
    settings.light_samples = 0;
    return std::make_unique<PathIntegrator>(settings);
}

std::unique_ptr<const Integrator> make_hemisphere(IntegratorSettings settings) {
    settings.even_directions = true;
    return make_naive(std::move(settings));
}

std::unique_ptr<const Integrator> make_bdpt(IntegratorSettings settings) {
    settings.merging = {.at = MergeAt::Nothing};
    return std::make_unique<BdptIntegrator>(settings);
}

constexpr std::string_view kLampImages = "/integrator/lamp_images";
constexpr std::string_view kAimedEmission = "/integrator/aimed_emission";
constexpr std::string_view kOfLightPaths[] = {kAimedEmission};
constexpr std::string_view kOfSplitting[] = {"/integrator/light_samples", kLampImages};
constexpr std::string_view kOfStrategies[] = {"/integrator/heuristic",   kStrategySetting, "/integrator/weighted",
                                              "/integrator/connections", kLampImages,      kAimedEmission};
constexpr std::string_view kOfMerging[] = {"/integrator/heuristic",   kStrategySetting,    "/integrator/weighted",
                                           "/integrator/connections", "/integrator/merge", "/integrator/merge_radius",
                                           "/integrator/merge_alpha", kLampImages,         kAimedEmission};

constexpr IntegratorEntry kRegistry[] = {
    {.name = "path",
     .summary = "eye paths with light sampling, combined by MIS",
     .make = make<PathIntegrator>,
     .own_settings = kOfSplitting},
    {.name = "direct",
     .summary = "path, one bounce only",
     .make = [](const IntegratorSettings& settings) { return make_direct(settings); },
     .longest_path = kDirectPath,
     .own_settings = kOfSplitting},
    {.name = "naive",
     .summary = "eye paths that find lights by chance",
     .make = [](const IntegratorSettings& settings) { return make_naive(settings); }},
    {.name = "hemisphere",
     .summary = "like naive, but matt and rough surfaces sample directions uniformly: for teaching",
     .make = [](const IntegratorSettings& settings) { return make_hemisphere(settings); }},
    {.name = "light",
     .summary = "paths from the lights, connected to the camera",
     .make = make<LightIntegrator>,
     .own_settings = kOfLightPaths,
     .has_alpha = false},
    {.name = "bdpt",
     .summary = "eye and light paths, connected in every way, combined by MIS",
     .make = [](const IntegratorSettings& settings) { return make_bdpt(settings); },
     .own_settings = kOfStrategies},
    {.name = "vcm",
     .summary = "bdpt that merges subpaths where nothing connects them: caustics seen in mirrors and through glass",
     .make = make<BdptIntegrator>,
     .own_settings = kOfMerging,
     .merges = true},
    {.name = "whitted",
     .summary = "mirrored and refracted rays, direct light, and no more",
     .make = make<WhittedIntegrator>,
     .has_expressions = false},
    {.name = "normals",
     .summary = "shading normals, for debugging",
     .make = make<NormalsIntegrator>,
     .has_expressions = false,
     .shows_light = false},
    {.name = "albedo",
     .summary = "scattered share of light, for debugging",
     .make = make<AlbedoIntegrator>,
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

std::unique_ptr<const Integrator> make_integrator(std::string_view name, const IntegratorSettings& settings) {
    const IntegratorEntry* const entry = find_integrator(name);
    return entry != nullptr ? entry->make(settings) : nullptr;
}

}  // namespace etendue
