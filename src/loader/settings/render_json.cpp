#include "loader/settings/render_json.h"

#include "core/byte_size.h"
#include "core/shown_text.h"
#include "loader/files.h"
#include "loader/json_text.h"
#include "loader/loader.h"
#include "loader/settings/json_object.h"

#include <fmt/format.h>

namespace etendue {

namespace {

using Json = nlohmann::json;

constexpr std::int64_t kLargestInt = std::numeric_limits<int>::max();
constexpr std::int64_t kMaxSide = 65536;
constexpr std::int64_t kMaxSpp = 1 << 24;
constexpr std::int64_t kMaxSeed = std::numeric_limits<std::uint32_t>::max();
constexpr NumberRange kFieldOfView{.min = 0.0, .max = 3.141592, .open_min = true};
constexpr NumberRange kFilterRadius{.min = 0.0, .max = 8.0, .open_min = true};
constexpr NumberRange kIor{.min = 1.0, .max = 3.0, .open_min = true};
constexpr NumberRange kSurfaceIor{.min = 1.0, .max = 3.0};
constexpr NumberRange kAnisotropy{.min = -0.999, .max = 0.999};
constexpr std::int64_t kMaxPriority = 1'000'000;

constexpr std::array<std::pair<std::string_view, SamplerType>, 2> kSamplers{{
    {"sobol", SamplerType::Sobol},
    {"random", SamplerType::Random},
}};
constexpr std::array<std::pair<std::string_view, HeuristicType>, 2> kHeuristics{{
    {"power", HeuristicType::Power},
    {"balance", HeuristicType::Balance},
}};
constexpr std::array<std::pair<std::string_view, PixelFilterType>, 4> kFilters{{
    {"blackman-harris", PixelFilterType::BlackmanHarris},
    {"box", PixelFilterType::Box},
    {"gaussian", PixelFilterType::Gaussian},
    {"mitchell", PixelFilterType::Mitchell},
}};
constexpr std::array<std::pair<std::string_view, CameraType>, 2> kNamedCameraTypes{{
    {"perspective", CameraType::Perspective},
    {"orthographic", CameraType::Orthographic},
}};
constexpr auto kMetals = [] {
    std::array<std::pair<std::string_view, std::string_view>, kMetalNames.size()> names{};
    for (std::size_t i = 0; i < names.size(); ++i) names[i] = {kMetalNames[i], kMetalNames[i]};
    return names;
}();

void read_integrator(const Json& value, const SourceLocation& where, ProblemList& problems, IntegratorSettings& out) {
    JsonObject object(value, where, problems);
    object.text("type", out.type);
    object.integer("max_depth", 1, kLargestInt, out.max_depth);
    object.integer("min_depth", 1, kLargestInt, out.min_depth);
    object.integer("roulette_depth", 1, kLargestInt, out.roulette_depth);
    object.integer("light_samples", 1, kMostLightSamples, out.light_samples);
    object.choice("heuristic", kHeuristics, out.heuristic);
    std::array<int, 2> strategy{};
    if (object.integers("strategy", 0, kLargestInt, strategy)) out.strategy = strategy;
    object.boolean("weighted", out.weighted);
    std::string connections;
    if (object.text("connections", connections)) {
        if (const auto count = parse_connections(connections))
            out.cached_connections = *count;
        else
            problems.error(object.at("connections"), fmt::format("'{}' is not {}", connections, kConnectionsForm));
    }
    object.finish();
}

void read_film(const Json& value, const SourceLocation& where, ProblemList& problems, FilmSettings& out) {
    JsonObject object(value, where, problems);
    object.choice("filter", kFilters, out.filter);
    object.number("filter_radius", kFilterRadius, out.filter_radius);
    object.finish();
}

void read_color(const Json& value, const SourceLocation& where, ProblemList& problems, ColorSettings& out) {
    JsonObject object(value, where, problems);
    object.text("working_space", out.working_space);
    object.text("display", out.display);
    object.text("view", out.view);
    object.text("look", out.look);
    object.number("exposure", kAnyNumber, out.exposure);
    object.text("output_space", out.output_space);
    object.boolean("aces_container", out.aces_container);
    object.finish();
}

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

CameraDesc read_camera(const Json& value, const SourceLocation& where, CameraAim& view, ProblemList& problems) {
    CameraDesc camera;
    camera.name = "render.json";
    camera.location = where;
    JsonObject object(value, where, problems);
    object.text("name", camera.name);
    object.choice("type", kNamedCameraTypes, camera.type);
    for (const std::string_view key : {"position", "look_at"}) {
        if (!object.has(key)) problems.error(where, fmt::format("'{}' is missing", key));
    }
    const bool has_position = object.vector("position", view.position);
    const bool has_look_at = object.vector("look_at", view.look_at);
    object.vector("up", view.up);
    object.number("yfov", kFieldOfView, camera.yfov);
    object.number("ymag", kPositive, camera.ymag);
    object.number("lens_radius", kNotNegative, camera.lens_radius);
    view.focuses = !object.number("focus_distance", kPositive, camera.focus_distance);
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
    object.number("ior", kSurfaceIor, result.ior);
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
    if (models > 1) problems.error(where, "only one of conductor, dielectric, diffuse and subsurface may be given");
    if (value.is_object() && models == 0 && !result.emission && !result.priority) {
        problems.error(where, "one of conductor, dielectric, diffuse, subsurface, emission and priority must be given");
    }
    object.finish();
    return result;
}

LightOverride read_light(const Json& value, const SourceLocation& where, ProblemList& problems) {
    LightOverride result;
    result.location = where;
    JsonObject object(value, where, problems);
    Rgb color;
    float intensity = 0.0f;
    if (object.color("color", kNotNegative, color)) result.color = color;
    if (object.number("intensity", kNotNegative, intensity)) result.intensity = intensity;
    object.text("ies", result.ies);
    object.number("scale", kNotNegative, result.scale);
    object.boolean("enabled", result.enabled);
    object.finish();
    return result;
}

void read_camera_member(JsonObject& object, RenderJson& out) {
    const Json* member = object.member("camera");
    if (member == nullptr) return;
    if (member->is_object()) {
        out.camera = read_camera(*member, object.at("camera"), out.camera_aim, object.problems());
        out.settings.camera = out.camera->name;
    } else if (member->is_string()) {
        object.text("camera", out.settings.camera);
    } else {
        object.problems().error(object.at("camera"), "must be the name of a camera or an object that describes one");
    }
}

void read_film_size(JsonObject& object, FilmSettings& film) {
    std::array<int, 2> resolution{film.width, film.height};
    object.integers("resolution", 1, kMaxSide, resolution);
    film.width = resolution[0];
    film.height = resolution[1];
    std::array<int, 4> crop{};
    if (object.integers("crop", 0, kMaxSide, crop)) film.crop = crop;
}

/// "depth", "caustics=lpe:C D S+ L:float", as on the command line.
void read_aovs(JsonObject& object, RenderSettings& settings) {
    object.choice("aov_layout", kAovLayoutNames, settings.aov_layout);
    const Json* member = object.member("aovs");
    if (member == nullptr) return;
    const SourceLocation where = object.at("aovs");
    if (!member->is_array()) {
        object.problems().error(where, "must be a list of texts");
        return;
    }
    for (std::size_t i = 0; i < member->size(); ++i) {
        const Json& element = (*member)[i];
        const SourceLocation place{where.file, fmt::format("{}/{}", where.pointer, i)};
        auto aov = element.is_string() ? parse_aov(element.get_ref<const std::string&>()) : std::nullopt;
        if (!aov) {
            object.problems().error(place, fmt::format("must be a text of the form {}", kAovForm));
            continue;
        }
        aov->location = place;
        settings.aovs.push_back(std::move(*aov));
    }
}

void read_texture_memory(JsonObject& object, RenderSettings& settings) {
    std::string text;
    if (!object.text("texture_memory", text)) return;
    settings.texture_memory = parse_byte_size(text);
    if (!settings.texture_memory)
        object.problems().error(object.at("texture_memory"), fmt::format("'{}' is not {}", text, kByteSizeForm));
}

/// [first, last] or [first, last, step].
void read_frames(JsonObject& object, RenderSettings& settings) {
    object.number("fps", kPositive, settings.fps);
    const Json* member = object.member("frames");
    if (member == nullptr) return;
    FrameRange frames;
    constexpr std::int64_t kMost = FrameRange::kMaxFrame;
    std::array<int, 2> ends{};
    std::array<int, 3> ends_and_step{};
    if (member->is_array() && member->size() == 3) {
        if (!object.integers("frames", -kMost, kMost, ends_and_step)) return;
        frames = {ends_and_step[0], ends_and_step[1], ends_and_step[2]};
    } else {
        if (!object.integers("frames", -kMost, kMost, ends)) return;
        frames = {ends[0], ends[1], 1};
    }
    if (frames.last < frames.first || frames.step < 1) {
        object.problems().error(object.at("frames"),
                                "must be [first, last] or [first, last, step] with first <= last "
                                "and step >= 1");
        return;
    }
    settings.frames = frames;
}

void read_overrides(JsonObject& object, RenderJson& out) {
    ProblemList& problems = object.problems();
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
}

/// The whole document. To add a key, see CONTRIBUTING.md (A setting).
void read_document(const Json& value, ProblemList& problems, RenderJson& out) {
    JsonObject object(value, out.location, problems);
    RenderSettings& settings = out.settings;
    object.text("scene", out.scene);
    object.text("variant", settings.variant);
    if (double seconds = 0.0; object.number("time_code", kAnyNumber, seconds)) settings.time_code = seconds;
    object.text("animation", settings.animation);
    read_frames(object, settings);
    std::array<float, 2> shutter{};
    if (object.numbers("shutter", kAnyNumber, shutter)) {
        settings.shutter = {static_cast<double>(shutter[0]), static_cast<double>(shutter[1])};
    }
    object.choice("sampler", kSamplers, settings.sampler);
    object.choice("light_units", kLightUnitNames, settings.light_units);
    object.choice("missing_textures", kMissingTexturesNames, settings.missing_textures);
    object.integer("spp", 1, kMaxSpp, settings.spp);
    object.integer("seed", 0, kMaxSeed, settings.seed);
    object.number("time", kNotNegative, settings.time_limit);
    object.number("error", kNotNegative, settings.relative_error);
    object.number("clamp_indirect", kNotNegative, settings.clamp_indirect);
    if (std::string robust; object.text("robust", robust)) {
        if (const auto buckets = parse_robust(robust))
            settings.robust_buckets = *buckets;
        else
            problems.error(object.at("robust"), fmt::format("'{}' is not {}", shown(robust), kRobustForm));
    }
    object.integer("brightest", 0, kMostBrightest, settings.brightest);
    object.boolean("adaptive", settings.adaptive);
    object.integer("min_spp", 1, kMaxSpp, settings.min_spp);
    read_aovs(object, settings);
    read_texture_memory(object, settings);
    read_film_size(object, settings.film);
    read_camera_member(object, out);
    if (float radius = 0.0f; object.number("lens_radius", kNotNegative, radius)) out.lens_radius = radius;
    if (float distance = 0.0f; object.number("focus_distance", kPositive, distance)) out.focus_distance = distance;
    if (const Json* member = object.member("integrator")) {
        read_integrator(*member, object.at("integrator"), problems, settings.integrator);
    }
    if (const Json* member = object.member("film")) read_film(*member, object.at("film"), problems, settings.film);
    if (const Json* member = object.member("color")) read_color(*member, object.at("color"), problems, settings.color);
    if (const Json* member = object.member("environment")) {
        out.environment = read_environment(*member, object.at("environment"), problems);
    }
    read_overrides(object, out);
    object.finish();
}

}  // namespace

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
        read_document(document, problems, result);
    } catch (const IoError& error) {
        problems.error(result.location, error.what());
    } catch (const SceneError& error) {
        for (const Problem& problem : error.problems().all()) problems.add(problem);
    }
    return result;
}

}  // namespace etendue
