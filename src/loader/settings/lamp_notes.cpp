#include "loader/settings/lamp_notes.h"

#include "core/shown_text.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Returns about how much light, lux, the lamp brings to a scene with these bounds.
double illuminance_of(const LightDesc& light, const Bounds& bounds) {
    const auto strength = static_cast<double>(light.intensity * average(light.color));
    if (light.type == LightType::Directional) return strength;
    const Vec3f to_lamp = transform_point(light.to_world, Vec3f(0.0f)) - bounds.center();
    // A lamp in the midst of the scene is half its size away from what it lights.
    const float nearest = 0.25f * length(bounds.size());
    return strength / static_cast<double>(std::max(length_squared(to_lamp), nearest * nearest));
}

}  // namespace

void note_bright_lamps(const std::map<std::string, LightOverride>& changes, const SceneDesc& scene,
                       ProblemList& problems) {
    const bool is_set = std::ranges::any_of(changes, [](const auto& entry) {
        const LightOverride& change = entry.second;
        return !change.kind && (change.intensity || change.power || change.irradiance || change.scale != 1.0f);
    });
    const Bounds bounds = compute_bounds(scene);
    if (is_set || scene.settings.light_units != LightUnits::Photometric || scene.settings.color.exposure ||
        !(length(bounds.size()) > 0.0f))
        return;
    double illuminance = 0.0;
    for (const LightDesc& light : scene.lights)
        if (!light.profile) illuminance += illuminance_of(light, bounds);
    // A white wall shows white at pi lux. A lamp of ten watts, exported by 683 lm/W, brings as much at a metre.
    constexpr double kWhite = 3.14159265;
    constexpr double kTooBright = 100.0;
    if (!(illuminance > kTooBright * kWhite)) return;
    problems.note({scene.file.string(), "/extensions/KHR_lights_punctual"},
                  fmt::format("the lights bring about {:.0f} times what shows white: if they were watts that an "
                              "exporter has turned into lumens (Blender's Standard), --light-units radiometric "
                              "divides by 683; if not, see --exposure",
                              illuminance / kWhite));
}

void note_area_lamps(const std::map<std::string, LightOverride>& changes, const SceneDesc& scene,
                     ProblemList& problems) {
    constexpr std::string_view kAreaName = "Area";
    std::vector<bool> is_used(scene.nodes.size(), false);
    for (const NodeDesc& node : scene.nodes)
        if (node.parent != NodeDesc::kNone) is_used[node.parent] = true;
    for (const InstanceDesc& instance : scene.instances)
        if (instance.node != NodeDesc::kNone) is_used[instance.node] = true;
    const auto is_other = [&](const std::string& name) {
        return changes.contains(name) ||
               std::ranges::find(scene.lights, name, &LightDesc::node) != scene.lights.end() ||
               std::ranges::find(scene.cameras, name, &CameraDesc::node) != scene.cameras.end() ||
               std::ranges::any_of(changes, [&](const auto& entry) { return entry.second.place.node == name; });
    };
    std::size_t count = 0;
    const std::string* first = nullptr;
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const std::string& name = scene.nodes[i].name;
        if (is_used[i] || !name.starts_with(kAreaName) || is_other(name)) continue;
        if (first == nullptr) first = &name;
        ++count;
    }
    if (count == 0) return;
    problems.note(
        {scene.file.string(), "/nodes"},
        fmt::format("{} may have been {}, for which glTF has no light; \"lights\": {{\"{}\": {{\"type\": "
                    "\"rectangle\", \"width\": 1, \"height\": 1, \"power\": 100}}}} in render.json makes it one",
                    count == 1 ? fmt::format("the empty node '{}'", shown(*first))
                               : fmt::format("{} empty nodes, such as '{}',", count, shown(*first)),
                    count == 1 ? "an area lamp" : "area lamps", shown(*first)));
}

}  // namespace etendue
