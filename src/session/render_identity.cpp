#include "session/render_identity.h"

#include "core/content_hash.h"
#include "output/software_name.h"
#include "processor/ray_code.h"
#include "scene/settings_text.h"
#include "world/compile.h"

#include <array>
#include <cstddef>
#include <filesystem>
#include <span>
#include <sstream>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Lines of `dump` that are about how long to render, of which pixels, and how to show it.
bool is_left_out(std::string_view line) {
    constexpr std::array<std::string_view, 5> kLeftOut{
        "sampling:", "crop:", "texture memory:", "layout of layers:", "colour:"};
    for (const std::string_view start : kLeftOut)
        if (line.starts_with(start)) return true;
    return false;
}

/// Up to the colon; of layers, with their names.
std::string setting_name(const std::string& line) {
    return line.substr(0, line.find_first_of(line.starts_with("aov ") ? "=" : " :"));
}

}  // namespace

RenderIdentity settings_identity(const RenderSettings& settings) {
    RenderIdentity identity;
    identity["seed"] = fmt::format("{}", settings.seed);
    identity["sampler"] = settings.sampler == SamplerType::Random ? "random" : "sobol";
    std::istringstream lines(dump(settings));
    for (std::string line; std::getline(lines, line);)
        if (!is_left_out(line)) identity["setting " + setting_name(line)] = line;
    return identity;
}

RenderIdentity render_identity(const SceneDesc& scene, std::span<const InputFile> inputs,
                               const std::string& working_space) {
    RenderIdentity identity = settings_identity(scene.settings);
    identity["program"] = fmt::format("{}, build {}", software_name(), software_build());
    identity["instruction set"] = instruction_set_name(ray_code().instruction_set);
    identity["working space"] = working_space;
    identity["textures"] = holds_textures_in_memory(scene) ? "in memory" : "in a cache (--texture-memory)";
    for (const InputFile& input : inputs) {
        const std::filesystem::path path = input.path;
        const std::string name = "content of " + (path.is_absolute() ? path.filename().string() : input.path);
        // Files outside of the scene's directory may have one name.
        std::string unique = name;
        for (int i = 2; identity.contains(unique); ++i) unique = fmt::format("{} ({})", name, i);
        identity[unique] = input.content;
    }
    // The settings are the end of it.
    const std::string text = dump(scene);
    ContentHash content;
    content.add(std::as_bytes(std::span(text).first(text.size() - dump(scene.settings).size())));
    identity["scene"] = hex(content.digest());
    return identity;
}

}  // namespace etendue
