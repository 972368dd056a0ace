#include "core/shown_text.h"
#include "image/read.h"
#include "loader/files.h"
#include "loader/json_text.h"
#include "loader/settings/apply_lights.h"
#include "loader/settings/json_object.h"
#include "loader/settings/known_names.h"
#include "loader/settings/render_json.h"

#include <algorithm>
#include <map>
#include <span>
#include <string_view>

#include <fmt/format.h>

namespace etendue {

namespace {

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
            problems.add({change.is_from_extras ? Severity::Warning : Severity::Error,
                          {change.location.file, child_pointer(change.location.pointer, name)},
                          fmt::format("'{}' is of KHR_materials_pbrSpecularGlossiness, which has no {}",
                                      shown(material.name), name)});
        else
            each.apply(material);
    }
    if (!change.solid) return;
    material.volume.closed = *change.solid;
    if (*change.solid && material.transmission == 0.0f && material.diffuse_transmission.factor == 0.0f)
        problems.warning({change.location.file, child_pointer(change.location.pointer, "solid")},
                         fmt::format("'{}' is solid, but transmits no light", shown(material.name)));
}

/// Makes the camera see `material` as `seen_as`, or no longer so.
void set_seen_as(SeenAs seen_as, bool is_set, MaterialDesc& material) {
    if (is_set)
        material.seen_as = seen_as;
    else if (material.seen_as == seen_as)
        material.seen_as = SeenAs::Surface;
}

void apply_material(const MaterialOverride& change, MaterialDesc& material, ProblemList& problems) {
    material.override_model = change.model;
    apply_factors(change, material, problems);
    if (change.priority) apply_priority(*change.priority, change.location, material, problems);
    material.visible_to_camera = change.visible_to_camera.value_or(material.visible_to_camera);
    if (change.catches_shadows) set_seen_as(SeenAs::Shadow, *change.catches_shadows, material);
    if (change.is_holdout) set_seen_as(SeenAs::Hole, *change.is_holdout, material);
    if (change.emission) set_emission(change.emission->color, change.emission->strength, material);
}

void apply_materials(const RenderJson& json, SceneDesc& scene, ProblemList& problems) {
    if (json.materials.empty()) return;
    std::multimap<std::string_view, MaterialDesc*> materials;
    for (MaterialDesc& material : scene.materials)
        if (!material.name.empty()) materials.emplace(material.name, &material);
    KnownNames known([&scene] { return names_of(scene.materials); });
    for (const auto& [name, change] : json.materials) {
        const auto [begin, end] = materials.equal_range(name);
        if (begin == end)
            problems.error(change.location,
                           fmt::format("the scene has no material '{}'; {}", shown(name), known.hint(name, problems)));
        for (auto entry = begin; entry != end; ++entry) apply_material(change, *entry->second, problems);
    }
}

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
    apply_camera_changes(json.lens, json.cameras, json.said_of_camera, scene, problems);
}

void apply_environment(const RenderJson& json, std::span<const std::filesystem::path> assets, SceneDesc& scene,
                       ProblemList& problems) {
    if (!json.environment) return;
    scene.environment = *json.environment;
    if (scene.environment.image.empty()) return;

    const std::string name = scene.environment.image.string();
    const std::string& source = scene.environment.location.file;
    const SourceLocation where{source, child_pointer(scene.environment.location.pointer, "image")};
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
        // Mistakes in the scene file's extras are warnings, never errors.
        const bool is_from_extras = source != json.location.file;
        scene.environment.enabled = !is_from_extras;
        problems.add({is_from_extras ? Severity::Warning : Severity::Error, where,
                      fmt::format("'{}': {}", shown(name), error.what())});
    }
}

}  // namespace

void apply_render_json(const RenderJson& json, std::span<const std::filesystem::path> assets, SceneDesc& scene,
                       ProblemList& problems) {
    apply_camera(json, scene, problems);
    apply_environment(json, assets, scene, problems);
    apply_materials(json, scene, problems);
    apply_shapes(json.shapes, scene, problems);
    apply_lights(json.lights, scene, problems);
}

}  // namespace etendue
