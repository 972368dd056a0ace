#include "batch/batch_units.h"

#include "color/color_config.h"
#include "core/error.h"
#include "core/log.h"
#include "core/shown_text.h"
#include "loader/loader.h"
#include "picture/aov_setup.h"
#include "picture/output_paths.h"
#include "session/image_files.h"
#include "session/usage_error.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <exception>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fnmatch.h>

namespace etendue {

namespace {

namespace fs = std::filesystem;

/// How files of layers go on after an image's name where they are named after a light.
constexpr std::string_view kLayerOfLight = ".light_";

struct FoundScene {
    fs::path path;
    fs::path root;     ///< the directory given, below which it was found
    std::string name;  ///< path below the output directory, without extension
};

/// A scene's name is its path below the root; with several roots that hold the same name, the root's name comes first.
std::vector<FoundScene> find_scenes(const std::vector<std::string>& roots) {
    std::vector<FoundScene> scenes;
    std::map<std::string, int> uses;
    std::set<fs::path> seen;
    for (const std::string& text : roots) {
        // Absolute, so that "." has a name, and without a trailing slash, so that the last component has one.
        fs::path root = fs::absolute(text).lexically_normal();
        if (!root.has_filename()) root = root.parent_path();
        const auto add = [&](const fs::path& scene, const fs::path& below, std::string name) {
            if (!seen.insert(scene).second) return;
            // In an output's name, a '#' stands for the frame's number.
            std::ranges::replace(name, '#', '_');
            scenes.push_back({scene.lexically_proximate(fs::current_path()), below, name});
            ++uses[name];
        };
        std::error_code said_by_loading;
        if (!fs::is_directory(root, said_by_loading)) {
            add(root, root.parent_path(), root.stem().string());
            continue;
        }
        for (const fs::path& scene : find_scene_directories(root)) {
            const fs::path relative = scene.lexically_relative(root);
            add(scene, root, (relative == "." ? root.filename() : relative).string());
        }
    }
    for (FoundScene& scene : scenes)
        if (uses[scene.name] > 1) scene.name = (scene.root.filename() / scene.name).string();
    return scenes;
}

/// A variant's name as a part of a file's: without what means something there, such as '/' and the '#' of frames.
std::string file_part(const std::string& variant) {
    constexpr std::size_t kMostBytes = 100;
    const std::string_view name = first_characters(variant, kMostBytes);
    std::string part;
    for (std::size_t at = 0; at < name.size();) {
        const std::string_view character = name.substr(at, character_length(name, at));
        part += character == "/" || character == "#" || !is_shown(character) ? "_" : character;
        at += character.size();
    }
    // As a folder, these would be others.
    if (part == "." || part == "..") part.assign(part.size(), '_');
    return part;
}

/// Returns a suffix for each name, of which none is another's: ".red".
std::vector<std::string> suffixes_of(const std::vector<std::string>& names) {
    std::set<std::string> used;
    std::map<std::string, int> numbers;
    std::vector<std::string> suffixes;
    suffixes.reserve(names.size());
    for (const std::string& name : names) {
        const std::string part = file_part(name);
        std::string suffix = "." + part;
        while (!used.insert(suffix).second)
            suffix = fmt::format(".{}-{}", part, ++numbers.try_emplace(part, 1).first->second);
        suffixes.push_back(suffix);
    }
    return suffixes;
}

/// Returns each of the names once. Throws SceneError if no command line can ask for one; `what` they name.
std::vector<std::string> distinct_names(const fs::path& scene, const std::vector<std::string>& names,
                                        const char* what) {
    std::vector<std::string> distinct;
    std::set<std::string> seen;
    for (const std::string& name : names) {
        if (!seen.insert(name).second) continue;
        if (name.find('\0') != std::string::npos)
            throw SceneError({scene.string(), {}},
                             fmt::format("the {} '{}' cannot be asked for, since its name holds the character NUL, "
                                         "where words of a command line end; rename it",
                                         what, shown(name)));
        distinct.push_back(name);
    }
    return distinct;
}

struct ScenePart {
    std::optional<std::string> variant{};
    std::optional<std::string> camera{};
    std::string variant_suffix{};  ///< ".red"
    std::string camera_suffix{};   ///< ".front"
    std::string label{};           ///< follows the scene's name in what people read: " variant red camera front"
};

/// Returns `what` and `name`, " camera front", or only `name`, " Camera.001", if it begins with `what`.
std::string labelled(const std::string& what, const std::string& name) {
    const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
    const bool says_itself = std::ranges::equal(name.substr(0, what.size()), what, {}, lower, lower);
    return says_itself ? " " + name : fmt::format(" {} {}", what, name);
}

/// Returns an entry for each variant and camera of a scene, or the scene as it is.
std::vector<ScenePart> parts_of(const fs::path& scene, const SceneNames& names) {
    std::vector<ScenePart> parts{{}};
    if (const auto variants = distinct_names(scene, names.variants, "material variant"); !variants.empty()) {
        parts.clear();
        const std::vector<std::string> suffixes = suffixes_of(variants);
        parts.reserve(variants.size());
        for (std::size_t i = 0; i < variants.size(); ++i)
            parts.push_back(
                {.variant = variants[i], .variant_suffix = suffixes[i], .label = labelled("variant", variants[i])});
    }
    const auto cameras = distinct_names(scene, names.cameras, "camera");
    if (cameras.empty()) return parts;
    const std::vector<std::string> suffixes = suffixes_of(cameras);
    std::vector<ScenePart> all;
    for (const ScenePart& part : parts)
        for (std::size_t i = 0; i < cameras.size(); ++i) {
            ScenePart& one = all.emplace_back(part);
            one.camera = cameras[i];
            one.camera_suffix = suffixes[i];
            one.label += labelled("camera", cameras[i]);
        }
    return all;
}

constexpr std::string_view kCamera = "{camera}";
constexpr std::array<std::string_view, 4> kPlaceholders{"{scene}", "{variant}", kCamera, "{frame}"};

/// Returns the pattern with `values` in the places of `kPlaceholders`. An empty value also removes the mark before its
/// placeholder or, at the beginning of a name, the marks after it.
std::string filled(std::string_view pattern, const std::array<std::string, kPlaceholders.size()>& values) {
    constexpr std::string_view kMarks = ".-_";
    std::string name;
    bool ends_with_value = false;  // marks within a value stay
    while (!pattern.empty()) {
        const auto* const found = std::ranges::find_if(
            kPlaceholders, [&](std::string_view placeholder) { return pattern.starts_with(placeholder); });
        if (found == kPlaceholders.end()) {
            name += pattern.front();
            pattern.remove_prefix(1);
            ends_with_value = false;
            continue;
        }
        pattern.remove_prefix(found->size());
        const std::string& value = values[static_cast<std::size_t>(found - kPlaceholders.begin())];
        name += value;
        ends_with_value = ends_with_value || !value.empty();
        if (!value.empty()) continue;
        if (name.empty() || name.back() == '/')
            pattern.remove_prefix(std::min(pattern.find_first_not_of(kMarks), pattern.size()));
        else if (!ends_with_value && kMarks.find(name.back()) != std::string_view::npos)
            name.pop_back();
    }
    return name;
}

/// Returns `name` without folders that have no name, of placeholders without a value.
fs::path without_empty_folders(const std::string& name) {
    fs::path kept;
    for (const fs::path& part : fs::path(name))
        if (!part.empty() && part != "/") kept /= part;
    return kept;
}

/// Returns the path of an image below the output directory, without extension; a frame's number is "####" there. The
/// scene's camera is `shown_camera` where `part` asks for none. Throws UsageError if `pattern` leaves no name or leads
/// elsewhere.
std::string image_name(const std::string& pattern, const std::string& scene, const ScenePart& part,
                       const std::string& shown_camera, bool is_sequence) {
    if (pattern.empty()) return scene + part.variant_suffix + part.camera_suffix;
    const auto without_dot = [](const std::string& suffix) { return suffix.empty() ? suffix : suffix.substr(1); };
    const std::string camera =
        part.camera ? without_dot(part.camera_suffix) : file_part(shown_camera.empty() ? "camera" : shown_camera);
    const fs::path path = without_empty_folders(
        filled(pattern, {scene, without_dot(part.variant_suffix), camera, is_sequence ? "####" : ""}));
    if (path.empty())
        throw UsageError(fmt::format("--name '{}' leaves no name for an image of {}", pattern, shown(scene)));
    if (std::ranges::any_of(path, [](const fs::path& folder) { return folder == "." || folder == ".."; }))
        throw UsageError(fmt::format("--name '{}' names the image '{}' of {}, which is not below the output directory",
                                     pattern, shown(path.string()), shown(scene)));
    return path.string();
}

/// Returns true if the glob matches the name of the image or its scene, the last part of either, or a folder above.
bool matches(const std::string& glob, const BatchTask& task) {
    std::vector<std::string> names{task.id, task.scene_name};
    for (const fs::path path : {task.id, task.scene_name}) names.push_back(path.filename().string());
    for (fs::path folder = fs::path(task.scene_name).parent_path(); !folder.empty(); folder = folder.parent_path())
        names.push_back(folder.string());
    return std::ranges::any_of(names,
                               [&](const std::string& name) { return fnmatch(glob.c_str(), name.c_str(), 0) == 0; });
}

/// Returns the first names of the images, for a message.
std::string some_names(const std::vector<BatchTask>& tasks) {
    constexpr std::size_t kMost = 5;
    std::string text;
    for (std::size_t i = 0; i < std::min(kMost, tasks.size()); ++i)
        text += fmt::format("{}{}", i == 0 ? "" : ", ", shown(tasks[i].id));
    return tasks.size() > kMost ? text + fmt::format(" and {} more", tasks.size() - kMost) : text;
}

/// Parts what --only and --exclude choose from the rest.
BatchTasks choose(std::vector<BatchTask> tasks, const BatchOptions& options) {
    if (tasks.empty()) return {};
    const auto any = [](const std::vector<std::string>& globs, const BatchTask& task) {
        return std::ranges::any_of(globs, [&](const std::string& glob) { return matches(glob, task); });
    };
    const auto names_none = [&](const std::string& glob) {
        return std::ranges::none_of(tasks, [&](const BatchTask& task) { return matches(glob, task); });
    };
    const auto require_matches = [&](const char* option, const std::vector<std::string>& globs) {
        for (const std::string& glob : globs)
            if (names_none(glob))
                throw UsageError(
                    fmt::format("{} '{}' matches no image; there are {} (a glob matches the name of an image or a "
                                "scene, or the last part of one, or a folder: '*' is any text, '?' a character)",
                                option, glob, some_names(tasks)));
    };
    require_matches("--only", options.only);
    require_matches("--exclude", options.exclude);
    BatchTasks parted;
    for (BatchTask& task : tasks) {
        const bool is_chosen = (options.only.empty() || any(options.only, task)) && !any(options.exclude, task);
        (is_chosen ? parted.chosen : parted.left_out).push_back(std::move(task));
    }
    if (parted.chosen.empty())
        throw UsageError(options.only.empty() ? "--exclude leaves no image" : "--only and --exclude leave no image");
    return parted;
}

/// Names of the layers of the scene's images that have files of their own, as settings tell them. Those that are named
/// after what is in the scene are among them if `reads_scene`, which takes as long as reading the scene.
std::vector<std::string> layers_with_files(const fs::path& scene, const SettingsOverrides& overrides,
                                           bool reads_scene) try {
    SceneDesc desc;
    desc.settings = find_settings(scene).value_or(RenderSettings());
    overrides.apply(desc.settings);
    const bool each_has_file = desc.settings.aov_layout == AovLayout::Files;
    if (reads_scene && each_has_file) desc = load_scene(scene, overrides.load_options()).scene;
    ProblemList ignored;
    return layers_with_files(make_aov_plan(desc, ignored), each_has_file);
} catch (const std::exception&) {
    return {};  // rendering the scene will say what is wrong
}

/// Says what to do about two images of one name.
std::string how_to_tell_apart(const BatchOptions& options) {
    std::vector<std::string_view> missing;
    for (const auto& [placeholder, tells_apart] :
         {std::pair(kPlaceholders[0], true), std::pair(kPlaceholders[1], options.all_variants),
          std::pair(kCamera, options.all_cameras)})
        if (tells_apart && options.name_pattern.find(placeholder) == std::string::npos) missing.push_back(placeholder);
    if (options.name_pattern.empty() || missing.empty())
        return "render the scenes to different directories, or rename one of them";
    return fmt::format("put {} into --name", fmt::join(missing, " and "));
}

/// Every file that the batch may write. Throws SceneError if two of them would have one name.
std::vector<fs::path> files_of(const std::vector<BatchTask>& tasks, const BatchOptions& options) {
    std::vector<fs::path> files = batch_files(options.output);
    std::set<fs::path> taken(files.begin(), files.end());
    std::map<fs::path, std::vector<std::string>> layers;
    std::set<std::string> images;
    for (const BatchTask& task : tasks) images.insert(task.job.output.string());
    for (const BatchTask& task : tasks) {
        const auto [of_scene, is_new] = layers.try_emplace(task.job.scene);
        // Names of lamps are asked for only if an image could have the name of such a layer.
        fs::path of_lights = task.job.output;
        const std::string beginning = of_lights.replace_extension(kLayerOfLight).string();
        const auto next = images.lower_bound(beginning);
        const bool may_meet = next != images.end() && next->starts_with(beginning);
        if (is_new || may_meet) of_scene->second = layers_with_files(task.job.scene, options.overrides, may_meet);
        std::vector<fs::path> of_image = files_of_image(task.job.output, of_scene->second);
        if (options.denoise) {
            const fs::path denoised = denoised_path(task.job.output);
            of_image.insert(of_image.end(), {denoised, fs::path(denoised).replace_extension(".png")});
        }
        for (fs::path& file : of_image) {
            if (!taken.insert(file).second)
                throw SceneError({task.job.scene.string(), {}}, fmt::format("two files would be written to '{}'; {}",
                                                                            file.string(), how_to_tell_apart(options)));
            files.push_back(std::move(file));
        }
    }
    return files;
}

/// Throws ReplacedInput if the log or one of `outputs` is read for an image. What does not exist yet is nobody's input:
/// scenes are looked at only if there is something to replace.
void require_scenes_kept(std::vector<fs::path> outputs, const std::vector<BatchTask>& tasks,
                         const BatchOptions& options) {
    std::error_code ignored;
    std::erase_if(outputs, [&](const fs::path& file) { return !fs::exists(file, ignored); });
    const bool has_log = fs::exists(options.log, ignored);
    if (outputs.empty() && !has_log) return;
    std::vector<fs::path> inputs = ColorConfig::environment_files();
    if (auto file = options.overrides.environment_file()) inputs.push_back(std::move(*file));
    const fs::path* last = nullptr;  // tasks of one scene are beside each other
    for (const BatchTask& task : tasks) {
        if (last == nullptr || *last != task.job.scene)
            for (fs::path& input : find_inputs(task.job.scene, options.overrides.assets))
                inputs.push_back(std::move(input));
        last = &task.job.scene;
    }
    require_inputs_kept("--output", outputs, inputs);
    if (has_log) require_inputs_kept("--log", std::array{options.log}, inputs);
}

/// Throws UsageError if the log is one of the files that the batch writes.
void require_log_apart(const fs::path& log, const std::vector<fs::path>& outputs) {
    for (const fs::path& file : outputs)
        if (file.filename() == log.filename() && written_file(file) == written_file(log))
            throw UsageError(
                fmt::format("--log '{}': the batch writes this file itself; name another one", log.string()));
}

}  // namespace

std::vector<fs::path> batch_files(const fs::path& output) {
    return {output / "report.json", output / "index.html", output / "ledger.jsonl"};
}

fs::path denoised_path(const fs::path& output) {
    return fs::path(output).replace_extension(".denoised.exr");
}

void check_name_pattern(const std::string& pattern) {
    const auto fail = [&](const std::string& why) { throw UsageError(fmt::format("--name '{}': {}", pattern, why)); };
    const std::string rest = filled(pattern, {"x", "x", "x", "x"});
    if (rest.find_first_of("{}") != std::string::npos)
        fail(fmt::format("braces stand around what is put in only: {}", fmt::join(kPlaceholders, ", ")));
    const fs::path path(rest);
    if (!path.has_filename() || path.filename() == "." || path.extension() == ".exr")
        fail("it must end in the name of an image, without .exr");
    if (path.is_absolute() || std::ranges::find(path, "..") != path.end())
        fail("it names images below the output directory");
    if (fs::path(pattern).parent_path().string().find("{frame}") != std::string::npos)
        fail("{frame} must stand in the last part, which names the file");
}

BatchTasks collect_tasks(const BatchOptions& options, const FindNames& find_names) {
    std::vector<BatchTask> all;
    for (const FoundScene& scene : find_scenes(options.roots)) {
        SceneNames names;
        const bool names_camera = options.name_pattern.find(kCamera) != std::string::npos;
        if (options.all_variants || options.all_cameras || names_camera) names = find_names(scene.path);
        if (!options.all_variants) names.variants.clear();
        if (!options.all_cameras) names.cameras.clear();
        const bool is_sequence = frames_of(scene.path, options.overrides).has_value();
        for (const ScenePart& part : parts_of(scene.path, names)) {
            const fs::path output =
                options.output /
                (image_name(options.name_pattern, scene.name, part, names.shown_camera, is_sequence) + ".exr");
            for (ImageJob& job : image_jobs(scene.path, output, scene.name + part.label, options.overrides)) {
                job.variant = part.variant;
                job.camera = part.camera;
                const fs::path below = job.output.lexically_relative(options.output);
                all.push_back({std::move(job), output, (below.parent_path() / below.stem()).string(), scene.name});
            }
        }
    }
    BatchTasks tasks = choose(std::move(all), options);
    const std::vector<fs::path> files = files_of(tasks.chosen, options);
    // Outputs must not replace files of scenes and images that are left out, either.
    require_scenes_kept(files, tasks.chosen, options);
    require_scenes_kept(files, tasks.left_out, options);
    if (options.log.empty()) return tasks;
    require_log_apart(options.log, files);
    for (const BatchTask& task : tasks.left_out) require_log_apart(options.log, files_of_image(task.job.output, {}));
    return tasks;
}

std::string why_not_denoised(const BatchTask& task, const BatchOptions& options) try {
    RenderSettings settings = find_settings(task.job.scene).value_or(RenderSettings());
    options.overrides.apply(settings);
    if (settings.color.aces_container)
        return "error: --denoise: an ACES container holds no layers, from which the noise is known; leave out one of "
               "both";
    if (settings.aov_layout == AovLayout::Files)
        return "error: --denoise: the layers must be in the image's own file; leave out --aov-layout files";
    if (settings.spp < 2)
        return "error: --denoise: the noise is known from two halves of the samples, and there is one sample (--spp)";
    return "";
} catch (const std::exception&) {
    return "";  // rendering the scene will say what is wrong
}

std::string note_on_exposures(std::span<const BatchTask> tasks, const SettingsOverrides& overrides) {
    const bool has_sequence =
        std::ranges::any_of(tasks, [](const BatchTask& task) { return task.job.frame.has_value(); });
    if (!has_sequence || !overrides.png || overrides.has("/color/exposure")) return {};
    return "note: the PNGs of frames that are made at once may flicker, since each frame without an exposure chooses "
           "its own: give --exposure, or \"exposure\" in render.json";
}

}  // namespace etendue
