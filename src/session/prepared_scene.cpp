#include "session/prepared_scene.h"

#include "color/color_config.h"
#include "loader/loader.h"
#include "output/software_name.h"
#include "picture/scene_completion.h"
#include "session/input_files.h"
#include "session/phase_timer.h"

#include <utility>

#include <fmt/format.h>

namespace etendue {

PreparedScene prepare_scene(const std::filesystem::path& path, const SettingsOverrides& overrides) {
    const PhaseTimer timer;
    const auto started = std::filesystem::file_time_type::clock::now();
    LoadedScene loaded = load_scene(path, overrides.moment);
    PreparedScene prepared{std::move(loaded.scene), std::move(loaded.problems), {}, {}};
    overrides.apply(prepared.scene);
    for (std::filesystem::path& file : ColorConfig::environment_files())
        prepared.scene.inputs.push_back(std::move(file));
    complete_scene(prepared.scene, prepared.problems);
    prepared.inputs = stamp_inputs(prepared.scene, started);
    prepared.load = timer.elapsed();
    return prepared;
}

std::string settings_hash(const SceneDesc& scene, PixelDepth depth) {
    std::string description = dump(scene);
    constexpr std::string_view kTextureMemory = "\ntexture memory:";
    if (const std::size_t begin = description.find(kTextureMemory); begin != std::string::npos)
        description.erase(begin, description.find('\n', begin + 1) - begin);
    // FNV-1a, 64 bits, over the text form of the scene; nobody attacks it, it only has to tell settings apart.
    const std::string text = fmt::format("{}\n{}\n{}\n{}", software_name(), description, static_cast<int>(depth),
                                         ColorConfig::environment_path().string());
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    return fmt::format("{:016x}", hash);
}

}  // namespace etendue
