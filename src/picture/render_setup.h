// From settings to what renders them: options of the film, the sampler and the integrator, and the colour space.
#pragma once

#include "color/color_config.h"
#include "integrator/integrator.h"
#include "picture/sample_ranges.h"
#include "render/render.h"
#include "scene/render_settings.h"
#include "world/world.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace etendue {

/// Returns what `settings` ask of the film and the sampler.
[[nodiscard]] RenderOptions make_render_options(const RenderSettings& settings);

/// Returns what `settings` ask of the film and the sampler for a part of the image, of `samples` or of all: light
/// subpaths shine on the whole image, and no limit but the number of samples ends the render.
[[nodiscard]] RenderOptions make_part_options(const RenderSettings& settings,
                                              const std::optional<SampleRange>& samples);

/// True if a render of these keeps every other pass by itself: for its own error, or for `has_halves`.
[[nodiscard]] bool keeps_every_other_pass(const RenderOptions& options, bool has_halves);

/// The state of a render that has not begun, with the films that it needs.
[[nodiscard]] RenderState make_render_state(const RenderOptions& options, bool has_halves);

/// Returns "'path' and 'direct'", the integrators for which `is_meant` is true.
[[nodiscard]] std::string integrators_that(const std::function<bool(const IntegratorEntry&)>& is_meant);

/// Names the integrators of the registry, in its order.
[[nodiscard]] std::vector<std::string> integrator_names();

/// Returns what the setting may be: `auto`, and all names of the registry.
[[nodiscard]] std::vector<std::string> integrator_setting_names();

/// True if the integrator of this name has strategies.
[[nodiscard]] bool has_strategies(const std::string& integrator);

/// True if the integrator of this name can show `strategy` alone.
[[nodiscard]] bool shows_strategy(const std::string& integrator, const Strategy& strategy);

/// Throws SceneError that blames `asked_for` if the integrator that the settings ask for has no strategies.
void require_strategies(const RenderSettings& settings, const SourceLocation& asked_for);

/// The integrator that the settings ask for. Throws SceneError with the nearest name if there is none of that name.
[[nodiscard]] std::unique_ptr<const Integrator> create_integrator(const RenderSettings& settings);

/// One sentence for each thing that was asked for and has no effect beside the other settings: options of adaptive
/// sampling without an error to reach, those of strategies with an integrator that has none, and a limit of indirect
/// light where all paths are too short to be any.
/// `has_bodies`: the scene's paths may scatter in media, which adds no edges to them.
[[nodiscard]] std::vector<std::string> ineffective_settings(const RenderSettings& settings, bool has_bodies);

/// A sentence for each thing that the render will not show although the scene or its settings ask for it: light that
/// the integrator cannot find, options and settings without effect.
[[nodiscard]] std::vector<std::string> notes_on(const World& world, const Integrator& integrator,
                                                const RenderSettings& settings);

/// Puts the config's defaults where `settings` name no space, display or view, and checks that everything exists.
/// Returns the working space; the settings name that of the EXR, too. Throws SceneError with the setting's location.
[[nodiscard]] std::string resolve_colors(RenderSettings& settings, const ColorConfig& colors);

}  // namespace etendue
