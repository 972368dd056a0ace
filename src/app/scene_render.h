// One scene, from its directory to its files: the data flow of the program in one function.
#pragma once

#include "app/output_paths.h"
#include "app/settings_overrides.h"
#include "app/strategies_image.h"
#include "color/color_config.h"
#include "core/parallel.h"
#include "integrator/integrator.h"
#include "output/statistics.h"

#include <filesystem>
#include <memory>
#include <string>

namespace etendue {

struct SceneRenderRequest {
    std::filesystem::path scene;  ///< scene directory or file, for messages
    std::filesystem::path
        output;  ///< the EXR; PNG and JSON stand beside it under the same name. Empty for NAME.exr here.
    StrategiesRequest strategies{};
    SettingsOverrides overrides;
    bool quiet = false;
    std::string title;  ///< before the progress bar
};

struct SceneRenderResult {
    RenderStatistics statistics;
    std::filesystem::path output;
    bool interrupted = false;
};

/// A scene as it will be rendered: loaded, overridden, completed and validated.
struct PreparedScene {
    SceneDesc scene;
    ProblemList problems;  ///< notes and warnings
    PhaseTime load;
};

/// Loads the scene directory or file `path` and applies overrides and defaults. Throws SceneError.
[[nodiscard]] PreparedScene prepare_scene(const std::filesystem::path& path, const SettingsOverrides& overrides);

/// Compiles, renders and writes. Notes and warnings go to stderr unless `quiet`. Throws SceneError for what is wrong
/// with the scene or its settings, IoError when a file cannot be written.
[[nodiscard]] SceneRenderResult render_scene(PreparedScene prepared, const SceneRenderRequest& request,
                                             const ThreadPool& threads);

/// `text` as one word of a shell's command line.
[[nodiscard]] std::string quoted(const std::string& text);

/// Throws IoError if `file` cannot be written later: better found before hours of rendering than after.
void require_writable(const std::filesystem::path& file);

/// What the settings ask of the film and the sampler.
[[nodiscard]] RenderOptions make_render_options(const RenderSettings& settings);

/// What the settings ask of the integrator.
[[nodiscard]] IntegratorOptions integrator_options(const RenderSettings& settings);

/// True if the integrator of this name has strategies.
[[nodiscard]] bool has_strategies(const std::string& integrator);

/// Throws SceneError that blames `asked_for` if the integrator that the settings ask for has no strategies.
void require_strategies(const RenderSettings& settings, const SourceLocation& asked_for);

/// The integrator that the settings ask for. Throws SceneError with the nearest name if there is none of that name.
[[nodiscard]] std::unique_ptr<const Integrator> create_integrator(const RenderSettings& settings);

/// Puts the config's defaults where `settings` name no space, display or view, and checks that everything exists.
/// Returns the working space. Throws SceneError with the setting's location.
[[nodiscard]] std::string resolve_colors(RenderSettings& settings, const ColorConfig& colors);

/// Hash of every setting that the image depends on, and of the program's version. Equal for equal pictures as long as
/// the input files are the same.
[[nodiscard]] std::string settings_hash(const SceneDesc& scene, PixelDepth depth);

}  // namespace etendue
