#include "session/output_checks.h"

#include "loader/loader.h"
#include "picture/output_paths.h"
#include "picture/render_setup.h"
#include "session/image_files.h"
#include "session/input_files.h"
#include "session/output_directory.h"
#include "session/up_to_date.h"
#include "session/usage_error.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>

namespace etendue {

namespace {

OutputPaths paths_of(const PlannedOutput& planned) {
    return OutputPaths::beside(planned.output, planned.request.overrides.png);
}

void require_all_writable(const OutputPaths& paths) {
    make_directory_of(paths.exr);
    for (const std::filesystem::path& path : {paths.exr, paths.png, paths.json})
        if (!path.empty()) require_writable(path);
}

/// Throws UsageError if `statistics` would be the settings of the scene in `directory`.
void require_no_settings(const std::filesystem::path& statistics, const std::filesystem::path& directory) {
    const auto or_here = [](const std::filesystem::path& path) { return path.empty() ? "." : path; };
    std::error_code none;  // a directory may be missing
    if (statistics.filename() == kSettingsName &&
        std::filesystem::equivalent(or_here(statistics.parent_path()), or_here(directory), none))
        throw UsageError(
            fmt::format("--output: its statistics, {}, would say how the scene is rendered: give the image "
                        "another name or directory",
                        statistics.string()));
}

/// Throws if the image of strategies cannot be written, would replace a file of the `image`, or would show nothing.
void check_strategies(const PlannedOutput& planned, std::span<const std::filesystem::path> image) {
    const std::filesystem::path& strategies = planned.request.strategies.output;
    const OutputPaths pyramid = OutputPaths::beside(strategies);
    require_inputs_kept(fmt::format("--strategies-image {}", strategies.string()), std::array{pyramid.exr, pyramid.png},
                        planned.scene.files_to_keep());
    require_all_writable(pyramid);
    require_strategies(planned.scene.settings, {"--strategies-image", {}});
    check_strategies_request(planned.request.strategies, image, planned.scene.settings, planned.options,
                             planned.request.overrides.depth);
}

}  // namespace

void require_no_layer_of_another(const std::filesystem::path& output) {
    const std::string name = output.filename().string();
    for (std::size_t dot = name.rfind('.', name.size() - output.extension().string().size() - 1);
         dot != std::string::npos && dot > 0; dot = name.rfind('.', dot - 1)) {
        const OutputPaths other = OutputPaths::beside(output.parent_path() / (name.substr(0, dot) + ".exr"));
        const std::vector<std::string> of_other = listed_layer_files(other);
        if (std::ranges::find(of_other, name) == of_other.end()) continue;
        throw SceneError({}, fmt::format("{} is a layer of the image {}, as {} tells, and would be lost; give the "
                                         "output another name, or remove the layer",
                                         output.string(), other.exr.string(), other.json.string()));
    }
}

void require_no_image_at(const std::filesystem::path& layer, const SourceLocation& where) {
    require_writable(layer);
    const std::filesystem::path other = OutputPaths::beside(layer).json;
    if (std::filesystem::exists(other))
        throw SceneError(where,
                         fmt::format("a layer would be written to {}, which is an image of its own, as {} tells; "
                                     "give the layer another name, or use another layout",
                                     layer.string(), other.string()));
}

void check_outputs(const PlannedOutput& planned) {
    const std::filesystem::path& output = planned.output;
    const std::vector<std::string> layers =
        layers_with_files(planned.aovs, planned.scene.settings.aov_layout == AovLayout::Files);
    const std::vector<std::filesystem::path> files = files_of_image(output, layers);
    require_inputs_kept(fmt::format("--output {}", output.string()), files, planned.scene.files_to_keep());
    if (!is_partial(output)) require_no_settings(paths_of(planned).json, planned.scene.directory);
    if (is_partial(output)) {
        if (intersection(planned.options.window, planned.options.splat_window) != planned.options.window)
            throw SceneError(planned.scene.settings.at("/crop"),
                             "a part lies within the image and its overscan: give it --overscan as well");
        require_depths_of_part(output, planned.options, planned.aovs, planned.integrator);
        make_directory_of(output);
        require_writable(output);
        return;
    }
    require_all_writable(paths_of(planned));
    require_no_layer_of_another(output);
    for (const std::string& layer : layers)
        require_no_image_at(layer_path(output, layer), planned.scene.settings.at("/aov_layout"));
    if (!planned.request.strategies.output.empty()) check_strategies(planned, files);
}

void require_depths_of_part(const std::filesystem::path& output, const RenderOptions& options, const AovPlan& aovs,
                            const Integrator& integrator) {
    const bool is_deep = aovs.set && aovs.set->layout.is_deep;
    const bool is_crop = options.window != options.splat_window;
    if (is_partial(output) && is_crop && is_deep && integrator.makes_splats())
        throw SceneError({"--deep", {}},
                         "a part that is a crop has no depths of the light that falls into others: render "
                         "parts that are ranges of samples (--samples), or with 'path'");
}

}  // namespace etendue
