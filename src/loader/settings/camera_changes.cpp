#include "loader/settings/camera_changes.h"

#include "core/shown_text.h"
#include "loader/json_text.h"
#include "loader/loader.h"
#include "loader/settings/known_names.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace etendue {

namespace {

using Json = nlohmann::json;

constexpr NumberRange kFieldOfView{.min = 0.0, .max = 3.141592, .open_min = true};
constexpr NumberRange kFisheyeAngle{.min = 0.0, .max = 6.2831855, .open_min = true};
constexpr float kUsualSensorWidth = 36.0f;  ///< millimetres, of 35 mm film

template <typename Value>
std::optional<Value> first_of(const std::optional<Value>& own, const std::optional<Value>& other) {
    return own ? own : other;
}

/// Returns what `own` says, and `all` of what it is silent on.
LensSettings merged(const LensSettings& own, const LensSettings& all) {
    const bool has_size = own.lens_radius || own.f_stop;
    const bool has_focus = own.focus_distance || !own.focus_node.empty();
    return {.lens_radius = has_size ? own.lens_radius : all.lens_radius,
            .focus_distance = has_focus ? own.focus_distance : all.focus_distance,
            .f_stop = has_size ? own.f_stop : all.f_stop,
            .focal_length = first_of(own.focal_length, all.focal_length),
            .sensor_width = first_of(own.sensor_width, all.sensor_width),
            .focus_node = has_focus ? own.focus_node : all.focus_node,
            .location = own.focus_node.empty() ? all.location : own.location};
}

/// Returns the height of the sensor in millimetres, whose longer side is `sensor_width`, for an image of this width
/// over height.
float sensor_height(float sensor_width, float aspect) {
    return sensor_width / std::max(aspect, 1.0f);
}

/// Makes the circle of a fisheye as large as the lens makes it, if its focal length is said.
void apply_fisheye_lens(const LensSettings& lens, float aspect, CameraDesc& camera) {
    if (!lens.focal_length) return;
    camera.focal_length = *lens.focal_length;
    const float shorter = lens.sensor_width.value_or(kUsualSensorWidth) / std::max(aspect, 1.0f / aspect);
    const float half_angle = 0.5f * camera.fov;
    const float radius = camera.focal_length *
                         (camera.fisheye == FisheyeType::Equisolid ? 2.0f * std::sin(0.5f * half_angle) : half_angle);
    camera.circle = 2.0f * radius / shorter;
}

/// Applies focal length and f-number to a perspective camera.
void apply_photographic(const LensSettings& lens, float image_aspect, CameraDesc& camera) {
    // A focal length is that of the image; else, the file says which view the f-number is of.
    const bool is_of_image = lens.focal_length || !(camera.aspect_ratio > 0.0f);
    const float aspect = is_of_image ? image_aspect : camera.aspect_ratio;
    const float height = sensor_height(lens.sensor_width.value_or(kUsualSensorWidth), aspect);
    if (lens.focal_length) camera.yfov = 2.0f * std::atan(0.5f * height / *lens.focal_length);
    camera.focal_length = 0.5f * height / std::tan(0.5f * camera.yfov);
    constexpr float kMetresPerMillimetre = 1e-3f;
    if (lens.f_stop) camera.lens_radius = camera.focal_length * kMetresPerMillimetre / (2.0f * *lens.f_stop);
}

/// Holds where a camera stands, in the scene's coordinates, and which way it looks.
struct View {
    Vec3f eye{0.0f};
    Vec3f forward{0.0f, 0.0f, -1.0f};
};

/// Returns where `camera` looks, or the place that the settings give the chosen camera.
View view_of(const SceneDesc& scene, const CameraDesc& camera, bool is_chosen) {
    const Mat4f& m = camera.to_world;
    if (const std::optional<CameraPlace>& place = scene.settings.camera_place; place && is_chosen)
        return {Vec3f(place->eye - scene.origin), Vec3f((place->target - place->eye).normalized())};
    return {Vec3f(m[3][0], m[3][1], m[3][2]), normalize(-Vec3f(m[2][0], m[2][1], m[2][2]))};
}

/// Focuses `camera` on the node `name`, unless that lies behind it; an error if it does and `must_see` it.
void focus_on_node(const SceneDesc& scene, const std::string& name, const View& view, const SourceLocation& where,
                   bool must_see, CameraDesc& camera, ProblemList& problems) {
    const Vec3f place = std::ranges::find(scene.nodes, name, &NodeDesc::name)->position();
    const float distance = dot(place - view.eye, view.forward);
    if (distance > 0.0f)
        camera.focus_distance = distance;
    else if (must_see)
        problems.error(
            where, fmt::format("the node '{}' is not in front of the camera '{}'", shown(name), shown(camera.name)));
}

/// Notes what is said of `camera` that cameras of its type do not have: of its lens, and of its view.
void note_without_effect(const LensSettings& lens, const ViewSettings& view, const SourceLocation& where,
                         const CameraDesc& camera, ProblemList& problems) {
    std::vector<std::string_view> ignored;
    const auto ignore = [&](bool is_said, std::string_view key) {
        if (is_said) ignored.push_back(key);
    };
    const bool is_perspective = camera.type == CameraType::Perspective;
    const bool is_fisheye = camera.type == CameraType::Fisheye;
    const bool is_pinhole = !is_perspective || camera.lens_radius == 0.0f;
    if (!is_perspective) ignore(camera.lens_radius > 0.0f, "lens_radius");
    if (!is_perspective) ignore(lens.f_stop.has_value(), "f_stop");
    if (is_pinhole) {
        ignore(lens.focus_distance.has_value(), "focus_distance");
        ignore(!lens.focus_node.empty(), "focus_node");
        ignore(camera.aperture.blades > 0, "blades");
        ignore(camera.aperture.rotation != 0.0f, "blade_rotation");
        ignore(camera.aperture.ratio != 1.0f, "aperture_ratio");
    }
    if (!is_perspective && !is_fisheye) {
        ignore(lens.focal_length.has_value(), "focal_length");
        ignore(lens.sensor_width.has_value(), "sensor_width");
    }
    const bool has_lens_alone = !ignored.empty();
    if (!is_fisheye) {
        ignore(view.fov.has_value(), "fov");
        ignore(view.mapping.has_value(), "mapping");
    }
    if (!is_perspective) ignore(view.yfov.has_value(), "yfov");
    if (camera.type != CameraType::Orthographic) ignore(view.ymag.has_value(), "ymag");
    if (ignored.empty()) return;
    const std::string_view hint = is_perspective && view.fov         ? "; yfov and focal_length say how much it sees"
                                  : is_perspective && has_lens_alone ? "; lens_radius or f_stop gives it a lens"
                                                                     : "";
    const std::string_view type =
        std::ranges::find(kCameraTypeNames, camera.type, &std::pair<std::string_view, CameraType>::second)->first;
    problems.note(where,
                  fmt::format("the camera '{}' is {}, and ignores {}{}", shown(camera.name),
                              is_perspective && is_pinhole ? "a pinhole" : type, fmt::join(ignored, ", "), hint));
}

/// False, with an error among `found`, if the scene has no node of this name; `all` are the problems of the scene.
bool has_node(const SceneDesc& scene, KnownNames& known, const std::string& name, const SourceLocation& where,
              const ProblemList& all, ProblemList& found) {
    if (std::ranges::find(scene.nodes, name, &NodeDesc::name) != scene.nodes.end()) return true;
    found.error(where, fmt::format("the scene has no node '{}'; {}", shown(name), known.hint(name, all)));
    return false;
}

}  // namespace

LensSettings read_lens(JsonObject& object) {
    LensSettings lens{.location = object.where()};
    const auto number = [&](std::string_view key, const NumberRange& range, std::optional<float>& value) {
        if (float read = 0.0f; object.number(key, range, read)) value = read;
    };
    number("lens_radius", kNotNegative, lens.lens_radius);
    number("focus_distance", kPositive, lens.focus_distance);
    number("f_stop", kPositive, lens.f_stop);
    number("focal_length", kPositive, lens.focal_length);
    number("sensor_width", kPositive, lens.sensor_width);
    object.text("focus_node", lens.focus_node);
    if (lens.f_stop && lens.lens_radius)
        object.problems().error(object.at("f_stop"), "lens_radius says the same: leave one of both out");
    if (!lens.focus_node.empty() && lens.focus_distance)
        object.problems().error(object.at("focus_node"), "focus_distance says the same: leave one of both out");
    return lens;
}

ViewSettings read_view(JsonObject& object) {
    ViewSettings view;
    const auto number = [&](std::string_view key, const NumberRange& range, std::optional<float>& value) {
        if (float read = 0.0f; object.number(key, range, read)) value = read;
    };
    if (CameraType type{}; object.choice("type", kCameraTypeNames, type)) view.type = type;
    number("yfov", kFieldOfView, view.yfov);
    number("ymag", kPositive, view.ymag);
    number("fov", kFisheyeAngle, view.fov);
    if (FisheyeType mapping{}; object.choice("mapping", kFisheyeTypeNames, mapping)) view.mapping = mapping;
    if (Vec2f shift; object.vector("shift", shift)) view.shift = shift;
    number("clip_start", kNotNegative, view.clip_start);
    number("clip_end", kPositive, view.clip_end);
    if (int blades = 0; object.integer("blades", 0, ApertureDesc::kMostBlades, blades)) {
        if (blades > 0 && blades < ApertureDesc::kLeastBlades)
            object.problems().error(object.at("blades"),
                                    fmt::format("must be 0 or at least {}", ApertureDesc::kLeastBlades));
        else
            view.blades = blades;
    }
    number("blade_rotation", kAnyNumber, view.blade_rotation);
    number("aperture_ratio", kPositive, view.aperture_ratio);
    return view;
}

void apply_view(const ViewSettings& view, CameraDesc& camera) {
    camera.type = view.type.value_or(camera.type);
    camera.yfov = view.yfov.value_or(camera.yfov);
    camera.ymag = view.ymag.value_or(camera.ymag);
    camera.fov = view.fov.value_or(camera.fov);
    camera.fisheye = view.mapping.value_or(camera.fisheye);
    camera.shift = view.shift.value_or(camera.shift);
    if (view.clips_as_file) camera.clip = camera.file_clip;
    camera.clip.start = view.clip_start.value_or(camera.clip.start);
    camera.clip.end = view.clip_end.value_or(camera.clip.end);
    camera.aperture.blades = view.blades.value_or(camera.aperture.blades);
    camera.aperture.rotation = view.blade_rotation.value_or(camera.aperture.rotation);
    camera.aperture.ratio = view.aperture_ratio.value_or(camera.aperture.ratio);
}

CameraChange read_camera_change(const Json& value, const SourceLocation& where, ProblemList& problems) {
    JsonObject object(value, where, problems);
    CameraChange change{.lens = read_lens(object), .view = read_view(object), .location = where};
    object.boolean("clip", change.view.clips_as_file);
    if (change.view.yfov && change.lens.focal_length)
        problems.error(object.at("yfov"), "focal_length says the same: leave one of both out");
    object.finish();
    return change;
}

void apply_camera_changes(const LensSettings& all, const std::map<std::string, CameraChange>& changes,
                          const CameraChange& own, SceneDesc& scene, ProblemList& problems) {
    if (!all.empty() && scene.cameras.empty())
        problems.warning(all.location, "what is said of the lens is ignored: the scene has no camera");
    KnownNames known_cameras([&scene] { return camera_names(scene); });
    KnownNames known_nodes([&scene] { return names_of(scene.nodes); });
    std::vector<const CameraChange*> change_of(scene.cameras.size(), nullptr);
    for (const auto& [name, change] : changes) {
        const CameraDesc* const camera = find_camera(scene, name);
        if (camera == nullptr) {
            problems.error(change.location, fmt::format("the scene has no camera '{}'; {}", shown(name),
                                                        known_cameras.hint(name, problems)));
            continue;
        }
        const CameraChange*& place = change_of[static_cast<std::size_t>(camera - scene.cameras.data())];
        // A camera and its node may both be named: render.json goes first.
        if (place != nullptr && change.is_from_extras) continue;
        if (place != nullptr && !place->is_from_extras)
            problems.error(change.location, fmt::format("'{}' is the same camera as '{}'", shown(name),
                                                        shown(name == camera->name ? camera->node : camera->name)));
        place = &change;
    }
    // Nobody looks for the node of all once for each camera.
    const auto at_focus = [](const SourceLocation& where) {
        return SourceLocation{where.file, child_pointer(where.pointer, "focus_node")};
    };
    const bool has_node_of_all = !all.focus_node.empty() && has_node(scene, known_nodes, all.focus_node,
                                                                     at_focus(all.location), problems, problems);
    const std::string& wanted = scene.settings.camera;
    const CameraDesc* const chosen = wanted.empty() ? scene.cameras.data() : find_camera(scene, wanted);
    for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
        CameraDesc& camera = scene.cameras[i];
        const CameraChange* const change = change_of[i];
        const LensSettings lens = change != nullptr ? merged(change->lens, all) : all;
        camera.lens_radius = lens.lens_radius.value_or(camera.lens_radius);
        camera.focus_distance = lens.focus_distance.value_or(camera.focus_distance);
        const bool is_photographic = lens.f_stop || lens.focal_length || lens.sensor_width;
        if (change != nullptr) apply_view(change->view, camera);
        if (camera.type == CameraType::Fisheye) apply_fisheye_lens(lens, scene.settings.film.aspect(), camera);
        if (is_photographic && camera.type == CameraType::Perspective)
            apply_photographic(lens, scene.settings.film.aspect(), camera);
        if (change != nullptr) {
            note_without_effect(lens, change->view, change->location, camera, problems);
        } else if (&camera == chosen) {
            const bool is_own = camera.location == own.location;
            note_without_effect(is_own ? merged(lens, own.lens) : lens, is_own ? own.view : ViewSettings(),
                                camera.location, camera, problems);
        }
        if (camera.type != CameraType::Perspective) camera.lens_radius = 0.0f;
        if (lens.focus_node.empty()) continue;
        const bool is_own = change != nullptr && !change->lens.focus_node.empty();
        const SourceLocation where = at_focus(lens.location);
        ProblemList found;
        if (is_own ? has_node(scene, known_nodes, lens.focus_node, where, problems, found) : has_node_of_all)
            focus_on_node(scene, lens.focus_node, view_of(scene, camera, &camera == chosen), where,
                          is_own || &camera == chosen, camera, found);
        for (Problem problem : found.all()) {
            if (is_own && change->is_from_extras) problem.severity = std::min(problem.severity, Severity::Warning);
            problems.add(std::move(problem));
        }
    }
}

}  // namespace etendue
