#include "session/option_check.h"

#include "color/color_config.h"
#include "core/error.h"
#include "picture/aov_setup.h"
#include "picture/render_setup.h"
#include "session/usage_error.h"

#include <string>

namespace etendue {

void check_options(const SettingsOverrides& overrides) {
    try {
        SceneDesc scene;
        overrides.apply(scene.settings);
        // The display may be the scene's own.
        if (!overrides.has("/color/display")) scene.settings.color.view.clear();
        (void)resolve_colors(scene.settings, ColorConfig::from_environment());
        // Expressions may name what only the scene has, and the limit of indirect light may be its own.
        std::erase_if(scene.settings.aovs, [](const AovDesc& aov) {
            return aov.source == "clamped" || aov.source.starts_with("light:") ||
                   aov.source.find('\'') != std::string::npos;
        });
        ProblemList ignored;
        (void)make_aov_plan(scene, ignored);
    } catch (const SceneError& error) {
        for (const Problem& problem : error.problems().all())
            if (problem.where.file.starts_with("--")) throw UsageError(problem.where.file + ": " + problem.message);
    }
}

}  // namespace etendue
