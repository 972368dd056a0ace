#include "core/shown_text.h"
#include "image/read.h"
#include "loader/files.h"
#include "loader/ies/ies_file.h"
#include "loader/json_text.h"
#include "loader/settings/json_object.h"
#include "loader/settings/render_json.h"

#include <algorithm>
#include <array>
#include <map>
#include <span>
#include <vector>

#include <fmt/format.h>

namespace etendue {

namespace {

/// The distinct names that `items` have.
template <typename Item>
std::vector<std::string_view> names_of(const std::vector<Item>& items) {
    std::vector<std::string_view> names;
    for (const Item& item : items) {
        if (!item.name.empty()) names.push_back(item.name);
    }
    std::ranges::sort(names);
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

template <typename Item>
bool check_name(const std::vector<Item>& items, std::string_view kind, const std::string& name,
                const SourceLocation& where, ProblemList& problems) {
    const std::vector<std::string_view> names = names_of(items);
    if (std::ranges::binary_search(names, std::string_view(name))) return true;
    problems.error(where, fmt::format("the scene has no {} '{}'; {}", kind, shown(name), name_hint(name, names)));
    return false;
}

/// Only bodies have one.
void apply_priority(int priority, const SourceLocation& where, MaterialDesc& material, ProblemList& problems) {
    if (auto* dielectric = std::get_if<DielectricDesc>(&material.override_model))
        dielectric->volume.priority = priority;
    else if (auto* subsurface = std::get_if<SubsurfaceDesc>(&material.override_model))
        subsurface->priority = priority;
    else if (std::holds_alternative<std::monostate>(material.override_model) && material.volume.closed)
        material.volume.priority = priority;
    else
        problems.warning(where, fmt::format("the priority of '{}' is ignored: its surfaces enclose no volume",
                                            shown(material.name)));
}

/// Gives the glTF material the factors of `change`, with errors for those that it does not have.
void apply_factors(const MaterialOverride& change, MaterialDesc& material, ProblemList& problems) {
    for (const FactorChange& each : change.factors) {
        const std::string name(each.factor->name);
        if (material.glossiness && !each.factor->in_glossiness)
            problems.error({change.location.file, child_pointer(change.location.pointer, name)},
                           fmt::format("'{}' is of KHR_materials_pbrSpecularGlossiness, which has no {}",
                                       shown(material.name), name));
        else
            each.apply(material);
    }
    if (!change.solid) return;
    material.volume.closed = *change.solid;
    if (*change.solid && material.transmission == 0.0f && material.diffuse_transmission.factor == 0.0f)
        problems.warning({change.location.file, child_pointer(change.location.pointer, "solid")},
                         fmt::format("'{}' is solid, but transmits no light", shown(material.name)));
}

void apply_materials(const RenderJson& json, SceneDesc& scene, ProblemList& problems) {
    for (const auto& [name, change] : json.materials) {
        if (!check_name(scene.materials, "material", name, change.location, problems)) continue;
        for (MaterialDesc& material : scene.materials) {
            if (material.name != name) continue;
            material.override_model = change.model;
            apply_factors(change, material, problems);
            if (change.priority) apply_priority(*change.priority, change.location, material, problems);
            if (!change.emission) continue;
            // Colours above 1 go into the strength, which has no upper bound.
            const float brightest = std::max(1.0f, max_component(change.emission->color));
            material.emissive = change.emission->color / brightest;
            material.emissive_strength = change.emission->strength * brightest;
            material.emissive_texture = {};
        }
    }
}

/// Reads each IES file once, however many lights name it.
class ProfileFiles {
  public:
    ProfileFiles(SceneDesc& scene, ProblemList& problems) : scene_(scene), problems_(problems) {}

    /// The profile in the file `name`; an invalid handle, reported at `where`, if it cannot be used.
    Handle<IesProfileDesc> profile(const std::string& name, const SourceLocation& where) {
        const auto [entry, is_new] = handles_.try_emplace(name);
        if (is_new) entry->second = read(name, where);
        return entry->second;
    }

  private:
    Handle<IesProfileDesc> read(const std::string& name, const SourceLocation& where) {
        try {
            const std::filesystem::path file = resolve_name(scene_.directory, name);
            const std::vector<unsigned char> bytes = read_bytes(file, kMaxIesBytes);
            scene_.ies_profiles.push_back(
                parse_ies({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, name, {file.string(), {}}));
            scene_.inputs.push_back(file);
            return {static_cast<std::int32_t>(scene_.ies_profiles.size()) - 1};
        } catch (const IoError& error) {
            problems_.error(where, fmt::format("'{}': {}", shown(name), error.what()));
        } catch (const SceneError& error) {
            for (const Problem& problem : error.problems().all()) problems_.add(problem);
        }
        return {};
    }

    SceneDesc& scene_;
    ProblemList& problems_;
    std::map<std::string, Handle<IesProfileDesc>> handles_;
};

void apply_light(const LightOverride& change, Handle<IesProfileDesc> profile, const SceneDesc& scene,
                 LightDesc& light) {
    light.color = change.color.value_or(light.color);
    if (profile) {
        light.profile = profile;
        light.intensity = 1.0f;  // as measured
    }
    if (change.intensity) {
        // Of a lamp with a profile it is the peak's, if that is not dark anyway.
        const float peak =
            light.profile ? peak_candela(scene.ies_profiles[static_cast<std::size_t>(light.profile.index)]) : 1.0f;
        light.intensity = peak > 0.0f ? *change.intensity / peak : 0.0f;
    }
    light.intensity *= change.scale;
}

/// Applies what the document says of lamps, by their own names and by those of their nodes.
class LightChanges {
  public:
    LightChanges(SceneDesc& scene, ProblemList& problems)
        : scene_(scene), problems_(problems), files_(scene, problems), is_enabled_(scene.lights.size(), true) {
        for (const std::string_view name : node_names_of_lights(scene)) node_names_.emplace_back(name);
    }

    void apply(const std::map<std::string, LightOverride>& changes) {
        // What is said of one node comes after what is said of all that share its lamp.
        for (const auto& [name, change] : changes)
            if (is_of_lamp(name))
                apply_to_those(change, [&, &lamp = name](std::size_t i) { return scene_.lights[i].name == lamp; });
        for (const auto& [name, change] : changes) {
            if (is_of_lamp(name)) continue;
            if (name.empty() || std::ranges::find(node_names_, name) == node_names_.end()) {
                report_unknown(name, change.location);
                continue;
            }
            apply_to_those(change, [&, &node = name](std::size_t i) { return node_names_[i] == node; });
        }
        std::size_t next = 0;
        std::erase_if(scene_.lights, [&](const LightDesc&) { return !is_enabled_[next++]; });
    }

  private:
    [[nodiscard]] bool is_of_lamp(const std::string& name) const {
        return !name.empty() && std::ranges::find(scene_.lights, name, &LightDesc::name) != scene_.lights.end();
    }

    void report_unknown(const std::string& name, const SourceLocation& where) {
        std::vector<std::string_view> names = names_of(scene_.lights);
        for (const std::string& node : node_names_)
            if (!node.empty()) names.push_back(node);
        problems_.error(where, fmt::format("the scene has no light '{}'; {}", shown(name), name_hint(name, names)));
    }

    void apply_to_those(const LightOverride& change, const auto& is_meant) {
        const SourceLocation where{change.location.file, child_pointer(change.location.pointer, "ies")};
        const Handle<IesProfileDesc> profile =
            change.ies.empty() ? Handle<IesProfileDesc>{} : files_.profile(change.ies, where);
        for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
            if (!is_meant(i)) continue;
            LightDesc& light = scene_.lights[i];
            is_enabled_[i] = is_enabled_[i] && change.enabled;
            if (profile && light.type == LightType::Directional)
                problems_.error(where, "a directional light has no position from which an IES profile could shine");
            else
                apply_light(change, profile, scene_, light);
        }
    }

    SceneDesc& scene_;
    ProblemList& problems_;
    ProfileFiles files_;
    std::vector<std::string> node_names_;  ///< by lamp, as `node_names_of_lights` has them
    std::vector<bool> is_enabled_;         ///< by lamp
};

void apply_camera(const RenderJson& json, SceneDesc& scene, ProblemList& problems) {
    if (json.camera) {
        if (std::ranges::find(scene.cameras, json.camera->name, &CameraDesc::name) != scene.cameras.end()) {
            problems.error(json.camera->location,
                           fmt::format("the scene already has a camera '{}'", shown(json.camera->name)));
        }
        scene.cameras.push_back(*json.camera);
        if (scene.origin != Vec3d(0.0) && !problems.has_errors())
            aim(json.camera_aim, scene.origin, scene.cameras.back());
    }
    apply_camera_changes(json.lens, json.cameras, scene, problems);
}

void apply_environment(const RenderJson& json, std::span<const std::filesystem::path> assets, SceneDesc& scene,
                       ProblemList& problems) {
    if (!json.environment) return;
    scene.environment = *json.environment;
    if (scene.environment.image.empty()) return;

    const std::string name = scene.environment.image.string();
    const SourceLocation where{json.location.file, child_pointer(scene.environment.location.pointer, "image")};
    scene.environment.image.clear();
    try {
        const std::filesystem::path file = resolve_asset(scene.directory, assets, name);
        const ImageInfo info = read_image_info(file);
        if (info.format != "openexr" && info.format != "hdr") {
            throw IoError("an environment is an EXR or HDR image, but this is " + info.format);
        }
        scene.environment.image = file;
        scene.inputs.push_back(file);
    } catch (const IoError& error) {
        problems.error(where, fmt::format("'{}': {}", shown(name), error.what()));
    }
}

}  // namespace

void apply_render_json(const RenderJson& json, std::span<const std::filesystem::path> assets, SceneDesc& scene,
                       ProblemList& problems) {
    apply_camera(json, scene, problems);
    apply_environment(json, assets, scene, problems);
    apply_materials(json, scene, problems);
    LightChanges(scene, problems).apply(json.lights);
}

}  // namespace etendue
