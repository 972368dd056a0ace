#include "picture/scene_completion.h"

#include "integrator/integrator.h"

#include <algorithm>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Throws SceneError if an integrator is asked for that does not see the shadow of a catcher in the scene.
void require_shadows_caught(const SceneDesc& scene) {
    const std::optional<std::string> catcher = shadow_catcher(scene);
    if (!catcher) return;
    if (const std::optional<std::string> reason = misses_shadows(scene.settings.integrator.type, *catcher))
        throw SceneError(scene.settings.at("/integrator/type"), *reason);
}

}  // namespace

std::optional<std::string> shadow_catcher(const SceneDesc& scene) {
    const auto catcher = std::ranges::find(scene.materials, true, &MaterialDesc::catches_shadows);
    return catcher == scene.materials.end() ? std::nullopt : std::optional(catcher->name);
}

std::optional<std::string> misses_shadows(const std::string& integrator, const std::string& catcher) {
    const IntegratorEntry* const entry = find_integrator(integrator);
    if (entry == nullptr || entry->catches_shadows) return std::nullopt;
    return fmt::format(
        "'{}' does not see what the material '{}' is to catch: paths from the lights have no alpha; all other "
        "integrators do",
        integrator, catcher);
}

void complete_scene(SceneDesc& scene, const SweptSpace& swept, ProblemList& problems) {
    add_missing_camera_and_light(scene, swept, problems);
    const ProblemList remaining = validate(scene);
    if (remaining.has_errors()) throw SceneError(remaining);
    apply_variant(scene);
    require_shadows_caught(scene);
}

}  // namespace etendue
