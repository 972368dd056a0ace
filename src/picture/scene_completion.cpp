#include "picture/scene_completion.h"

#include "integrator/integrator.h"

#include <algorithm>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Has `path` render where the pilot was to choose and the camera sees a shadow catcher. Throws SceneError if an
/// integrator is asked for that does not see its shadow.
void require_shadows_caught(SceneDesc& scene, ProblemList& problems) {
    const std::optional<std::string> catcher = shadow_catcher(scene);
    std::string& type = scene.settings.integrator.type;
    if (!catcher) return;
    if (type == kAutoIntegrator) {
        type = "path";
        problems.note(scene.settings.at("/integrator/type"),
                      fmt::format("'path' renders, as the material '{}' catches shadows", *catcher));
        return;
    }
    if (const std::optional<std::string> reason = misses_shadows(type, *catcher))
        throw SceneError(scene.settings.at("/integrator/type"), *reason);
}

}  // namespace

std::optional<std::string> shadow_catcher(const SceneDesc& scene) {
    const auto catcher = std::ranges::find(scene.materials, true, &MaterialDesc::catches_shadows);
    return catcher == scene.materials.end() ? std::nullopt : std::optional(catcher->name);
}

std::optional<std::string> misses_shadows(const std::string& integrator, const std::string& catcher) {
    const IntegratorEntry* const entry = find_integrator(integrator);
    if (entry == nullptr || entry->catches_shadows || !entry->shows_light) return std::nullopt;
    return fmt::format(
        "'{}' does not see what the material '{}' is to catch: connections from the light have no alpha; "
        "'path', 'direct' and 'naive' see shadow catchers",
        integrator, catcher);
}

void complete_scene(SceneDesc& scene, const SweptSpace& swept, ProblemList& problems) {
    add_missing_camera_and_light(scene, swept, problems);
    const ProblemList remaining = validate(scene);
    if (remaining.has_errors()) throw SceneError(remaining);
    apply_variant(scene);
    require_shadows_caught(scene, problems);
}

}  // namespace etendue
