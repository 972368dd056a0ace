#include "loader/settings/render_json.h"

#include "loader/files.h"
#include "loader/json_text.h"
#include "loader/loader.h"
#include "loader/settings/json_object.h"
#include "scene/old_setting_names.h"

#include <algorithm>

#include <fmt/format.h>

namespace etendue {

namespace {

using Json = nlohmann::json;

constexpr NumberRange kIor{.min = 1.0, .max = 3.0};
constexpr NumberRange kAnisotropy{.min = -static_cast<double>(kMostAnisotropic),
                                  .max = static_cast<double>(kMostAnisotropic)};
constexpr std::int64_t kMaxPriority = 1'000'000;

constexpr auto kMetals = [] {
    std::array<std::pair<std::string_view, std::string_view>, kMetalNames.size()> names{};
    for (std::size_t i = 0; i < names.size(); ++i) names[i] = {kMetalNames[i], kMetalNames[i]};
    return names;
}();

/// False, and an error, if there is no such view.
bool check_aim(const CameraAim& aim, JsonObject& object) {
    const Vec3f back(aim.position - aim.look_at);
    const Vec3f right = cross(aim.up, back);
    if (!(length_squared(back) > 0.0f) || !is_finite(back)) {
        object.problems().error(object.at("look_at"), "must differ from position");
        return false;
    }
    if (!(length_squared(right) > 1e-12f * length_squared(aim.up) * length_squared(back))) {
        object.problems().error(object.at("up"), "must not be zero or parallel to the viewing direction");
        return false;
    }
    return true;
}

CameraDesc read_camera(const Json& value, const SourceLocation& where, CameraAim& view, CameraChange& said,
                       ProblemList& problems) {
    CameraDesc camera;
    camera.name = "render.json";
    camera.location = where;
    JsonObject object(value, where, problems);
    object.text("name", camera.name);
    for (const std::string_view key : {"position", "look_at"}) {
        if (!object.has(key)) problems.error(where, fmt::format("'{}' is missing", key));
    }
    const bool has_position = object.vector("position", view.position);
    const bool has_look_at = object.vector("look_at", view.look_at);
    object.vector("up", view.up);
    object.number("lens_radius", kNotNegative, camera.lens_radius);
    if (float distance = 0.0f; object.number("focus_distance", kPositive, distance))
        said.lens.focus_distance = distance;
    view.focuses = !said.lens.focus_distance;
    camera.focus_distance = said.lens.focus_distance.value_or(camera.focus_distance);
    said.view = read_view(object);
    said.location = where;
    apply_view(said.view, camera);
    if (has_position && has_look_at && check_aim(view, object)) aim(view, Vec3d(0.0), camera);
    object.finish();
    return camera;
}

ConductorDesc read_conductor(const Json& value, const SourceLocation& where, ProblemList& problems) {
    ConductorDesc result;
    JsonObject object(value, where, problems);
    std::string_view metal;
    if (object.choice("metal", kMetals, metal)) result.metal = metal;
    object.number("roughness", kUnit, result.roughness);
    object.finish();
    return result;
}

DielectricDesc read_dielectric(const Json& value, const SourceLocation& where, ProblemList& problems) {
    DielectricDesc result;
    JsonObject object(value, where, problems);
    object.number("ior", kIor, result.ior);
    object.number("roughness", kUnit, result.roughness);
    object.color("attenuation_color", kUnit, result.volume.attenuation_color);
    object.number("attenuation_distance", kPositive, result.volume.attenuation_distance);
    object.number("dispersion", kNotNegative, result.volume.dispersion);
    object.color("multiscatter_color", kUnit, result.volume.multiscatter_color);
    object.number("scatter_anisotropy", kAnisotropy, result.volume.scatter_anisotropy);
    object.finish();
    return result;
}

DiffuseDesc read_diffuse(const Json& value, const SourceLocation& where, ProblemList& problems) {
    DiffuseDesc result;
    JsonObject object(value, where, problems);
    object.color("albedo", kUnit, result.albedo);
    object.number("roughness", kUnit, result.roughness);
    object.finish();
    return result;
}

SubsurfaceDesc read_subsurface(const Json& value, const SourceLocation& where, ProblemList& problems) {
    SubsurfaceDesc result;
    JsonObject object(value, where, problems);
    object.color("albedo", kUnit, result.albedo);
    object.color("radius", kPositive, result.radius);
    object.number("anisotropy", kAnisotropy, result.anisotropy);
    object.number("ior", kIor, result.ior);
    object.number("roughness", kUnit, result.roughness);
    object.finish();
    return result;
}

EmissionOverride read_emission(const Json& value, const SourceLocation& where, ProblemList& problems) {
    EmissionOverride result;
    JsonObject object(value, where, problems);
    object.color("color", kNotNegative, result.color);
    object.number("strength", kNotNegative, result.strength);
    object.finish();
    return result;
}

void read_factors(JsonObject& object, std::vector<FactorChange>& factors) {
    for (const MaterialFactor& factor : material_factors()) {
        float number = 0.0f;
        Rgb color;
        if (factor.number != nullptr && object.number(factor.name, factor.range, number))
            factors.push_back({&factor, number});
        if (factor.color != nullptr && object.color(factor.name, factor.range, color))
            factors.push_back({&factor, color});
    }
}

/// Reports what would have no effect beside something else.
void check_combination(const MaterialOverride& material, bool has_model, JsonObject& object) {
    const auto refuse = [&](std::string_view key) {
        object.problems().error(object.at(key), "a model takes the place of the glTF material: leave one of both out");
    };
    if (has_model && material.solid) refuse("solid");
    for (const FactorChange& change : material.factors) {
        const std::string_view name = change.factor->name;
        const bool is_emission = name.starts_with("emissive");
        if (has_model && !is_emission && name != "normal_scale" && name != "alpha_cutoff") refuse(name);
        if (is_emission && material.emission)
            object.problems().error(object.at(name), "'emission' takes its place: leave one of both out");
    }
}

/// May be an object in place of the name.
constexpr std::string_view kCameraPointer = "/camera";

void read_camera_member(JsonObject& object, RenderJson& out) {
    const Json* member = object.member("camera");
    if (member == nullptr) return;
    if (member->is_object()) {
        out.camera = read_camera(*member, object.at("camera"), out.camera_aim, out.said_of_camera, object.problems());
        out.settings.camera = out.camera->name;
    } else if (member->is_string()) {
        object.setting(*find_setting(kCameraPointer), "camera", out.settings);
    } else {
        object.problems().error(object.at("camera"), "must be the name of a camera or an object that describes one");
    }
}

/// Says where the setting stands whose pointer ends in `key`; empty if there is none.
std::string place_of_setting(std::string_view key) {
    for (const Setting& setting : settings_table()) {
        const std::size_t slash = setting.pointer.rfind('/');
        if (setting.pointer.substr(slash + 1) != key) continue;
        if (slash == 0) return "it belongs outside of this object";
        return fmt::format("it belongs in '{}'", setting.pointer.substr(1, slash - 1));
    }
    return {};
}

/// Reads the settings of the table that stand in `object`, whose pointer is `parent`, and in the objects within.
void read_table(JsonObject& object, std::string_view parent, RenderSettings& settings) {
    std::vector<std::string_view> objects;
    for (const Setting& setting : settings_table()) {
        if (!setting.pointer.starts_with(parent) || setting.pointer[parent.size()] != '/') continue;
        const std::string_view key = setting.pointer.substr(parent.size() + 1);
        const std::size_t slash = key.find('/');
        if (slash == std::string_view::npos) {
            if (setting.pointer != kCameraPointer) object.setting(setting, key, settings);
        } else if (objects.empty() || objects.back() != key.substr(0, slash)) {
            objects.push_back(key.substr(0, slash));
        }
    }
    for (const OldSettingName& old : kOldSettingNames) {
        const std::string_view key = old.pointer.substr(1);
        if (!parent.empty() || object.member(key) == nullptr) continue;
        object.setting(*find_setting(old.now), key, settings);
        object.problems().note(object.at(key),
                               fmt::format("'{}' is called '{}' now, and is taken for that", key, old.now.substr(1)));
    }
    std::ranges::sort(objects);
    objects.erase(std::unique(objects.begin(), objects.end()), objects.end());
    for (const std::string_view name : objects) {
        const Json* const member = object.member(name);
        if (member == nullptr) continue;
        JsonObject inner(*member, object.at(name), object.problems());
        read_table(inner, fmt::format("{}/{}", parent, name), settings);
        inner.finish(place_of_setting);
    }
}

void read_overrides(JsonObject& object, RenderJson& out) {
    ProblemList& problems = object.problems();
    if (const Json* member = object.member("cameras")) {
        JsonObject cameras(*member, object.at("cameras"), problems);
        cameras.each([&](const std::string& name, const Json& value) {
            out.cameras[name] = read_camera_change(value, cameras.at(name), problems);
        });
    }
    if (const Json* member = object.member("materials")) {
        JsonObject materials(*member, object.at("materials"), problems);
        materials.each([&](const std::string& name, const Json& value) {
            out.materials[name] = read_material(value, materials.at(name), problems);
        });
    }
    if (const Json* member = object.member("lights")) {
        JsonObject lights(*member, object.at("lights"), problems);
        lights.each([&](const std::string& name, const Json& value) {
            out.lights[name] = read_light(value, lights.at(name), problems);
        });
    }
    if (const Json* member = object.member("shapes")) {
        JsonObject shapes(*member, object.at("shapes"), problems);
        shapes.each([&](const std::string& name, const Json& value) {
            out.shapes[name] = read_shape(value, shapes.at(name), problems);
        });
    }
}

/// Reads the whole document.
void read_document(const Json& value, ProblemList& problems, RenderJson& out) {
    JsonObject object(value, out.location, problems);
    RenderSettings& settings = out.settings;
    object.text("scene", out.scene);
    read_table(object, "", settings);
    for (std::size_t i = 0; i < settings.aovs.size(); ++i)
        settings.aovs[i].location = {out.location.file, fmt::format("/aovs/{}", i)};
    read_camera_member(object, out);
    out.lens = read_lens(object);
    if (const Json* member = object.member("environment")) {
        out.environment = read_environment(*member, object.at("environment"), problems);
    }
    read_overrides(object, out);
    object.finish(place_of_setting);
}

}  // namespace

EnvironmentDesc read_environment(const Json& value, const SourceLocation& where, ProblemList& problems) {
    EnvironmentDesc result;
    result.enabled = true;
    result.location = where;
    JsonObject object(value, where, problems);
    std::string image;
    if (object.text("image", image)) result.image = image;
    object.color("color", kNotNegative, result.color);
    object.number("scale", kNotNegative, result.scale);
    object.number("rotation", kAnyNumber, result.rotation);
    object.boolean("visible_to_camera", result.visible_to_camera);
    object.finish();
    return result;
}

MaterialOverride read_material(const Json& value, const SourceLocation& where, ProblemList& problems) {
    MaterialOverride result;
    result.location = where;
    JsonObject object(value, where, problems);
    int models = 0;
    const auto model = [&](std::string_view name, auto read) {
        const Json* member = object.member(name);
        if (member == nullptr) return;
        result.model = read(*member, object.at(name), problems);
        ++models;
    };
    model("conductor", read_conductor);
    model("dielectric", read_dielectric);
    model("diffuse", read_diffuse);
    model("subsurface", read_subsurface);
    if (const Json* member = object.member("emission")) {
        result.emission = read_emission(*member, object.at("emission"), problems);
    }
    int priority = 0;
    if (object.integer("priority", -kMaxPriority, kMaxPriority, priority)) result.priority = priority;
    read_factors(object, result.factors);
    if (bool solid = false; object.boolean("solid", solid)) result.solid = solid;
    if (bool visible = true; object.boolean("visible_to_camera", visible)) result.visible_to_camera = visible;
    if (bool catches = true; object.boolean("shadow_catcher", catches)) result.catches_shadows = catches;
    if (bool is_holdout = true; object.boolean("holdout", is_holdout)) result.is_holdout = is_holdout;
    if (result.catches_shadows == true && result.is_holdout == true)
        problems.error(where, "cannot be a shadow catcher and a holdout");
    if (models > 1) problems.error(where, "only one of conductor, dielectric, diffuse and subsurface may be given");
    if (value.is_object() && value.empty()) problems.error(where, "says nothing of the material");
    check_combination(result, models > 0, object);
    object.finish();
    return result;
}

void aim(const CameraAim& aim, const Vec3d& origin, CameraDesc& camera) {
    const Vec3f position(aim.position - origin);
    Vec3f back = position - Vec3f(aim.look_at - origin);
    // So near each other that rounding has made them one.
    if (!(length_squared(back) > 0.0f)) back = Vec3f(aim.position - aim.look_at);
    if (aim.focuses) camera.focus_distance = length(back);
    const Vec3f z = normalize(back);
    const Vec3f x = normalize(cross(aim.up, back));
    const Vec3f y = cross(z, x);
    camera.to_world =
        Mat4f(x.x, x.y, x.z, 0.0f, y.x, y.y, y.z, 0.0f, z.x, z.y, z.z, 0.0f, position.x, position.y, position.z, 1.0f);
}

RenderJson read_render_json(const std::filesystem::path& file, std::string_view given, ProblemList& problems) {
    RenderJson result;
    result.file = file;
    result.location = {file.empty() ? kGivenSettings : file.string(), {}};
    result.settings.location = result.location;
    try {
        Json document = Json::object();
        if (!file.empty()) {
            const std::vector<unsigned char> bytes = read_bytes(file, kMaxSettingsBytes);
            const std::string_view text{reinterpret_cast<const char*>(bytes.data()), bytes.size()};
            document = parse_json(text, result.location);
        }
        if (!given.empty()) {
            const SourceLocation where{kGivenSettings, {}};
            const Json changes = parse_json(given, where);
            if (!changes.is_object()) throw SceneError(where, "the settings are no JSON object");
            document.merge_patch(changes);
        }
        result.document = document.dump();
        read_document(document, problems, result);
    } catch (const IoError& error) {
        problems.error(result.location, error.what());
    } catch (const SceneError& error) {
        for (const Problem& problem : error.problems().all()) problems.add(problem);
    }
    return result;
}

}  // namespace etendue
