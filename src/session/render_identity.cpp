#include "session/render_identity.h"

#include "core/content_hash.h"
#include "output/software_name.h"
#include "processor/ray_code.h"
#include "scene/canonical_settings.h"
#include "world/compile.h"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include <fmt/format.h>

namespace etendue {

RenderIdentity settings_identity(const RenderSettings& settings) {
    RenderIdentity identity;
    for (const auto& [pointer, text] : canonical_settings(settings, decides_pixels))
        identity[setting_name(*find_setting(pointer))] = text;
    return identity;
}

RenderIdentity render_identity(const SceneDesc& scene, std::span<const InputFile> inputs,
                               const std::string& working_space) {
    RenderSettings settings = scene.settings;
    settings.color.working_space = working_space;
    RenderIdentity identity = settings_identity(settings);
    identity["program"] = fmt::format("{}, build {}", software_name(), software_build());
    identity["instruction set"] = instruction_set_name(ray_code().instruction_set);
    identity["textures"] = holds_textures_in_memory(scene) ? "in memory" : "in a cache (--texture-memory)";
    for (const InputFile& input : inputs) {
        const std::filesystem::path path = input.path;
        const std::string name = "content of " + (path.is_absolute() ? path.filename().string() : input.path);
        // Files outside of the scene's directory may have one name.
        std::string unique = name;
        for (int i = 2; identity.contains(unique); ++i) unique = fmt::format("{} ({})", name, i);
        identity[unique] = input.content;
    }
    identity["scene"] = content_hex(dump_without_settings(scene));
    return identity;
}

}  // namespace etendue
