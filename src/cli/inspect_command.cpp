// etendue inspect: what is in a scene, and what is wrong with it.
#include "cli/commands.h"
#include "cli/settings_options.h"
#include "color/color_config.h"
#include "core/shown_text.h"
#include "core/standard_output.h"
#include "loader/loader.h"
#include "picture/aov_setup.h"
#include "picture/integrator_choice.h"
#include "picture/render_setup.h"
#include "picture/scene_completion.h"
#include "processor/ray_code.h"
#include "session/image_job.h"
#include "session/image_outline.h"
#include "session/interrupt.h"
#include "session/scene_render.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace etendue {

namespace {

struct InspectArguments {
    std::vector<std::string> paths;
    SettingsOverrides overrides;
    bool json = false;
};

struct Inspection {
    std::string path;  ///< scene directory or file
    std::string description;
    nlohmann::json summary;
    Bounds bounds;  ///< from `origin`
    Vec3d origin{0.0};
    std::size_t triangles = 0;
    std::size_t vertices = 0;
    std::size_t shapes = 0;
    ProblemList problems;
    std::optional<ImageOutline> outline;   ///< if the settings can be followed
    std::optional<WorldStatistics> world;  ///< if it could be compiled
};

template <typename T>
nlohmann::json names(const std::vector<T>& things) {
    nlohmann::json list = nlohmann::json::array();
    for (const T& thing : things) list.push_back(thing.name);
    return list;
}

/// Names of the nodes that place `things`.
template <typename T>
nlohmann::json nodes_of(const std::vector<T>& things) {
    nlohmann::json list = nlohmann::json::array();
    for (const T& thing : things) list.push_back(thing.node);
    return list;
}

nlohmann::json summarize(const SceneDesc& s) {
    return {{"scene", s.name},
            {"file", s.file.string()},
            {"meshes", names(s.meshes)},
            {"instances", s.instances.size()},
            {"materials", names(s.materials)},
            {"textures", s.textures.size()},
            {"images", s.images.size()},
            {"missing_textures", count_missing_textures(s)},
            {"lights", names(s.lights)},
            {"light_nodes", nodes_of(s.lights)},
            {"cameras", names(s.cameras)},
            {"camera_nodes", nodes_of(s.cameras)},
            {"scenes", s.scenes},
            {"variants", s.variants},
            {"light_units", light_units_name(s.settings.light_units)},
            {"ies_profiles", names(s.ies_profiles)},
            {"environment", s.environment.enabled},
            {"animations", s.animations},
            {"extensions_used", s.extensions_used},
            {"extensions_ignored", s.extensions_ignored}};
}

Inspection inspect(const std::string& path, const SettingsOverrides& overrides) {
    Inspection result;
    result.path = path;
    LoadOptions options = overrides.load_options();
    options.every_animation = true;
    // What a render of the sequence would show first.
    if (const std::optional<FrameRange> frames = frames_of(path, overrides)) options.frame = frames->frame(0);
    LoadedScene loaded = inspect_scene(path, options);
    SceneDesc& scene = loaded.scene;
    result.problems = std::move(loaded.problems);
    overrides.apply_environment(scene);
    // Of a file that cannot be read, nothing but the error is worth telling.
    const bool is_empty = scene.instances.empty() && scene.cameras.empty() && scene.lights.empty();
    const bool is_described = !scene.file.empty() && !(is_empty && result.problems.has_errors());
    if (is_described) result.description = dump(scene);
    result.summary = summarize(scene);
    result.summary["settings"] = nlohmann::json::parse(resolved_settings(scene.settings));
    result.bounds = compute_bounds(scene);
    result.origin = scene.origin;
    for (const MeshDesc& mesh : scene.meshes)
        for (const PrimitiveDesc& primitive : mesh.primitives) {
            result.triangles += primitive.triangles.size();
            result.vertices += primitive.shape ? 0 : primitive.positions.size();
            result.shapes += primitive.shape ? 1 : 0;
        }
    if (result.problems.has_errors()) return result;
    // Images are decoded and everything is built, because much of what can be wrong shows only then.
    try {
        complete_scene(scene, loaded.swept, result.problems);
        result.outline = outline_of(scene);
        RenderSettings settings = scene.settings;
        (void)replace_auto(settings);
        (void)create_integrator(settings);
        (void)make_aov_plan(scene, result.problems);
        const ThreadPool threads;
        const ColorConfig colors = ColorConfig::from_environment();
        const std::string working_space = resolve_colors(scene.settings, colors);
        const World world =
            ray_code().compile_world(std::move(scene), colors, working_space, threads, result.problems, {});
        result.world = world.statistics();
        result.summary["missing_textures"] = result.world->missing_textures;
    } catch (const SceneError& error) {
        for (const Problem& problem : error.problems().all()) result.problems.add(problem);
    }
    return result;
}

/// A point in the world, in single precision where that is all there is.
std::string place_text(const Vec3f& point, const Vec3d& origin) {
    if (origin == Vec3d(0.0)) return fmt::format("({:g} {:g} {:g})", point.x, point.y, point.z);
    const Vec3d place = Vec3d(point) + origin;
    return fmt::format("({:.12g} {:.12g} {:.12g})", place.x, place.y, place.z);
}

std::string to_text(const Inspection& i) {
    std::string text;
    const auto out = std::back_inserter(text);
    fmt::format_to(out, "{}", i.description);
    if (i.outline)
        fmt::format_to(out, "image: {}x{} pixels, {} samples per pixel, {}, camera '{}'\n", i.outline->width,
                       i.outline->height, i.outline->spp, shown_text(i.outline->integrator),
                       shown_text(i.outline->camera));
    if (!i.description.empty()) {
        if (i.bounds.empty())
            fmt::format_to(out, "bounds: none (nothing is placed)\n");
        else
            fmt::format_to(out, "bounds: {} to {} metres\n", place_text(i.bounds.min, i.origin),
                           place_text(i.bounds.max, i.origin));
        fmt::format_to(out, "triangles: {}, vertices: {}", i.triangles, i.vertices);
        fmt::format_to(out, "{}\n", i.shapes == 0 ? std::string() : fmt::format(", shapes: {}", i.shapes));
    }
    if (i.world)
        fmt::format_to(
            out,
            "compiled: {} triangles as seen, {} lights, {:.1f} MiB BVH in {:.2f} s ({:.2f} Mtris/s), {:.1f} MiB "
            "geometry, "
            "{:.1f} MiB textures\n",
            i.world->instanced_triangles, i.world->lights, static_cast<double>(i.world->bvh_bytes) / (1 << 20),
            i.world->bvh_build_seconds,
            static_cast<double>(i.world->triangles) / std::max(i.world->bvh_build_seconds, 1e-9) * 1e-6,
            static_cast<double>(i.world->geometry_bytes) / (1 << 20),
            static_cast<double>(i.world->texture_bytes) / (1 << 20));
    if (i.problems.all().empty()) fmt::format_to(out, "problems: none\n");
    for (const Problem& problem : i.problems.all()) fmt::format_to(out, "{}\n", shown_message(problem.str()));
    if (i.problems.dropped() > 0) fmt::format_to(out, "(and {} more problems)\n", i.problems.dropped());
    return text;
}

nlohmann::json place_json(const Vec3f& point, const Vec3d& origin) {
    if (origin == Vec3d(0.0)) return {point.x, point.y, point.z};
    const Vec3d place = Vec3d(point) + origin;
    return {place.x, place.y, place.z};
}

nlohmann::json to_json(const Inspection& i) {
    nlohmann::json json = i.summary;
    json["path"] = i.path;
    json["image"] = nullptr;
    if (i.outline)
        json["image"] = {{"width", i.outline->width},
                         {"height", i.outline->height},
                         {"spp", i.outline->spp},
                         {"integrator", i.outline->integrator},
                         {"camera", i.outline->camera}};
    json["triangles"] = i.triangles;
    json["vertices"] = i.vertices;
    json["shapes"] = i.shapes;
    json["bounds"] = nullptr;
    json["compiled"] = nullptr;
    json["problems"] = nlohmann::json::array();
    if (!i.bounds.empty())
        json["bounds"] = {{"min", place_json(i.bounds.min, i.origin)}, {"max", place_json(i.bounds.max, i.origin)}};
    if (i.world)
        json["compiled"] = {{"triangles_as_seen", i.world->instanced_triangles},
                            {"lights", i.world->lights},
                            {"bvh_bytes", i.world->bvh_bytes},
                            {"bvh_build_seconds", i.world->bvh_build_seconds},
                            {"geometry_bytes", i.world->geometry_bytes},
                            {"texture_bytes", i.world->texture_bytes}};
    constexpr const char* kSeverities[] = {"note", "warning", "error"};
    for (const Problem& problem : i.problems.all())
        json["problems"].push_back({{"severity", kSeverities[static_cast<int>(problem.severity)]},
                                    {"file", problem.where.file},
                                    {"pointer", problem.where.pointer},
                                    {"message", problem.message},
                                    {"text", problem.str()}});
    return json;
}

/// Returns the scenes at the paths: files and scene directories themselves, of other directories all below.
std::vector<std::string> find_scenes(const std::vector<std::string>& paths) {
    std::vector<std::string> scenes;
    for (const std::string& path : paths) {
        std::error_code said_by_loading;
        if (!std::filesystem::is_directory(path, said_by_loading)) {
            scenes.push_back(path);
            continue;
        }
        const std::vector<std::filesystem::path> found = find_scene_directories(path);
        // Why there is none, loading will say.
        if (found.empty() || std::filesystem::equivalent(found.front(), path, said_by_loading))
            scenes.push_back(path);
        else
            for (const std::filesystem::path& scene : found) scenes.push_back(scene.string());
    }
    return scenes;
}

ExitCode run_inspect(const InspectArguments& arguments) {
    const NothingToKeep while_reading;
    const std::vector<std::string> scenes = find_scenes(arguments.paths);
    nlohmann::json all = nlohmann::json::array();
    std::size_t wrong = 0;
    for (const std::string& scene : scenes) {
        const Inspection inspection = inspect(scene, arguments.overrides);
        if (inspection.problems.has_errors()) ++wrong;
        if (arguments.json)
            all.push_back(to_json(inspection));
        else
            print_text((scenes.size() > 1 ? fmt::format("== {}\n", shown_text(scene)) : "") + to_text(inspection));
    }
    if (arguments.json)
        print_data(
            (scenes.size() == 1 ? all.front() : all).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) +
            "\n");
    else if (scenes.size() > 1)
        print_text(fmt::format("== {} scenes, {} with errors\n", scenes.size(), wrong));
    return wrong > 0 ? ExitCode::InvalidScene : ExitCode::Success;
}

}  // namespace

void add_inspect_command(CLI::App& app, Action& action) {
    auto arguments = std::make_shared<InspectArguments>();
    CLI::App* command = app.add_subcommand("inspect", "Say what is in a scene and everything that is wrong with it");
    command
        ->add_option("SCENES", arguments->paths,
                     "Scene directories, .gltf or .glb files, or directories with scenes below them")
        ->required();
    add_settings_options(*command, arguments->overrides);
    command->add_flag("--json", arguments->json, "Print JSON; of several scenes, an array");
    command->footer(
        "Loads and compiles everything and renders nothing: a scene without errors here is one that 'render' takes "
        "with\n"
        "the same options. Exit code 3 if there is an error.\n\n"
        "Examples:\n"
        "  etendue inspect model.glb\n"
        "  etendue inspect scenes\n"
        "  etendue inspect shots/a shots/b --camera main --aov depth\n"
        "  etendue inspect scenes/cornell-box --json");
    command->callback([arguments, &action] { action = [arguments] { return run_inspect(*arguments); }; });
}

}  // namespace etendue
