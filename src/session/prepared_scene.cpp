#include "session/prepared_scene.h"

#include "color/color_config.h"
#include "core/content_hash.h"
#include "loader/loader.h"
#include "output/software_name.h"
#include "picture/scene_completion.h"
#include "scene/canonical_settings.h"
#include "session/input_files.h"
#include "session/phase_timer.h"

#include <utility>

#include <fmt/format.h>

namespace etendue {

PreparedScene prepare_scene(const std::filesystem::path& path, const SettingsOverrides& overrides) {
    const PhaseTimer timer;
    const auto started = std::filesystem::file_time_type::clock::now();
    LoadedScene loaded = load_scene(path, overrides.load_options());
    PreparedScene prepared{std::move(loaded.scene), std::move(loaded.problems), {}, {}};
    overrides.apply_environment(prepared.scene);
    for (std::filesystem::path& file : ColorConfig::environment_files())
        prepared.scene.inputs.push_back(std::move(file));
    complete_scene(prepared.scene, loaded.swept, prepared.problems);
    prepared.inputs = stamp_inputs(prepared.scene, started);
    prepared.load = timer.elapsed();
    return prepared;
}

std::string settings_hash(const SceneDesc& scene, const RenderSettings& settings, PixelDepth depth) {
    return content_hex(fmt::format("{}\n{}\n{}\n{}\n{}", software_name(), dump_without_settings(scene),
                                   to_json_object(canonical_settings(settings, decides_files)), static_cast<int>(depth),
                                   ColorConfig::environment_path().string()));
}

std::string settings_hash(const SceneDesc& scene, PixelDepth depth) {
    return settings_hash(scene, scene.settings, depth);
}

std::string requested_settings(const RenderSettings& settings) {
    return to_json_object(without_defaults(canonical_settings(settings, decides_files)));
}

}  // namespace etendue
