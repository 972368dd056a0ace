#include "picture/scene_completion.h"

#include "integrator/integrator.h"

#include <algorithm>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Throws SceneError if an integrator is asked for that has no alpha for the shadows or holes in the scene.
void require_alpha(const SceneDesc& scene) {
    const std::optional<std::string> material = replaced_material(scene);
    if (!material) return;
    if (const std::optional<std::string> reason = misses_alpha(scene.settings.integrator.type, *material))
        throw SceneError(scene.settings.at("/integrator/type"), *reason);
}

}  // namespace

std::optional<std::string> replaced_material(const SceneDesc& scene) {
    const auto found = std::ranges::find_if(
        scene.materials, [](const MaterialDesc& material) { return material.seen_as != SeenAs::Surface; });
    return found == scene.materials.end() ? std::nullopt : std::optional(found->name);
}

std::optional<std::string> misses_alpha(const std::string& integrator, const std::string& material) {
    const IntegratorEntry* const entry = find_integrator(integrator);
    if (entry == nullptr || entry->has_alpha) return std::nullopt;
    return fmt::format(
        "'{}' cannot show the material '{}' as a shadow catcher or a holdout: paths from the lights have no alpha; all "
        "other integrators can",
        integrator, material);
}

void complete_scene(SceneDesc& scene, const SweptSpace& swept, ProblemList& problems) {
    // The variant decides whether the scene has light.
    apply_variant(scene);
    add_missing_camera_and_light(scene, swept, problems);
    const ProblemList remaining = validate(scene);
    if (remaining.has_errors()) throw SceneError(remaining);
    require_alpha(scene);
}

}  // namespace etendue
