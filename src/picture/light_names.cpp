#include "picture/light_names.h"

#include "core/shown_text.h"
#include "picture/matte_names.h"

#include <algorithm>
#include <cctype>
#include <string_view>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Returns what expressions call a lamp or an object of this `name`; all without a name are called "unnamed".
std::string light_name(const std::string& name) {
    return name.empty() ? "unnamed" : name;
}

bool emits(const SceneDesc& scene, const InstanceDesc& instance) {
    const MeshDesc& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh.index)];
    return std::ranges::any_of(mesh.primitives, [&](const PrimitiveDesc& primitive) {
        return scene.materials[static_cast<std::size_t>(primitive.material.index)].emits();
    });
}

}  // namespace

PathNames path_names(const SceneDesc& scene) {
    PathNames names;
    for (const MaterialDesc& material : scene.materials) names.materials.push_back(material.name);
    for (const LightDesc& light : scene.lights) names.lights.push_back(light_name(light.name));
    for (const InstanceDesc& instance : scene.instances) names.lights.push_back(light_name(instance.name));
    names.lights.emplace_back("environment");
    const std::set<std::string_view> own_names(names.lights.begin(), names.lights.end());
    for (const std::string_view node : node_names_of_lights(scene))
        names.light_aliases.emplace_back(own_names.contains(node) ? std::string_view() : node);
    for (const InstanceDesc& instance : scene.instances) {
        const std::string& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh.index)].name;
        names.light_aliases.emplace_back(own_names.contains(mesh) ? std::string() : mesh);
    }
    return names;
}

std::vector<std::string> light_names(const SceneDesc& scene) {
    std::vector<std::string> names;
    std::set<std::string> seen;
    const auto add = [&](const std::string& name) {
        if (seen.insert(name).second) names.push_back(name);
    };
    for (const LightDesc& light : scene.lights) add(light_name(light.name));
    for (const InstanceDesc& instance : scene.instances)
        if (emits(scene, instance)) add(light_name(instance.name));
    if (scene.environment.enabled) add("environment");
    return names;
}

std::string layer_name(const std::string& name, std::set<std::string>& taken) {
    constexpr std::size_t kMostCharacters = 100;
    std::string plain;
    for (const char c : name) {
        if (continues_character(c) || plain.size() == kMostCharacters) continue;
        plain += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' ? c : '_';
    }
    std::string result = plain;
    for (int i = 2; !taken.insert(result).second; ++i) result = fmt::format("{}_{}", plain, i);
    return result;
}

std::string light_expression(std::string pattern) {
    if (pattern.find('\'') != std::string::npos && pattern.find('"') != std::string::npos)
        std::ranges::replace(pattern, '\'', '*');
    const char quote = pattern.find('\'') == std::string::npos ? '\'' : '"';
    return fmt::format("C .* <L{}{}{}>", quote, pattern, quote);
}

}  // namespace etendue
