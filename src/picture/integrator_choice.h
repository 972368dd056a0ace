// The integrator of a scene for which none was asked: the one that a pilot finds to be the quickest.
#pragma once

#include "core/parallel.h"
#include "integrator/pilot.h"
#include "scene/render_settings.h"
#include "world/world.h"

#include <cstddef>
#include <string>
#include <vector>

namespace etendue {

/// Returns the integrators that a pilot may choose from, those that serve what `settings` ask for. Throws SceneError
/// for settings that none could serve.
[[nodiscard]] std::vector<std::string> integrators_to_choose(const RenderSettings& settings);

/// Puts the first of those in place of `auto`, so that all else can be set up, and returns them; returns nothing where
/// `settings` name an integrator.
[[nodiscard]] std::vector<std::string> replace_auto(RenderSettings& settings);

/// Holds what was chosen.
struct IntegratorChoice {
    std::string integrator;  ///< name in the registry
    std::string reason;      ///< a sentence that names it
};

/// Chooses one of `integrators`, places in kComparedNames, the simplest first.
[[nodiscard]] IntegratorChoice choose_by(const PilotFindings& findings, const std::vector<std::size_t>& integrators);

/// Chooses one of `integrators` for `world`. The choice depends on the scene and the settings alone.
[[nodiscard]] IntegratorChoice choose_integrator(const World& world, const RenderSettings& settings,
                                                 const std::vector<std::string>& integrators,
                                                 const ThreadPool& threads);

}  // namespace etendue
