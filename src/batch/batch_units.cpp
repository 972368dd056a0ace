#include "batch/batch_units.h"

#include "color/color_config.h"
#include "core/error.h"
#include "core/shown_text.h"
#include "loader/loader.h"
#include "picture/aov_setup.h"
#include "picture/output_paths.h"
#include "session/image_files.h"

#include <exception>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>

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
        for (const fs::path& scene : find_scene_directories(root)) {
            if (!seen.insert(scene).second) continue;
            const fs::path relative = scene.lexically_relative(root);
            const std::string name = (relative == "." ? root.filename() : relative).string();
            scenes.push_back({scene.lexically_proximate(fs::current_path()), root, name});
            ++uses[name];
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
    return part;
}

struct ScenePart {
    std::optional<std::string> variant{};
    std::string suffix{};  ///< follows the scene's name in names of image files: ".red"
    std::string label{};   ///< follows the scene's name in what people read: " variant red"
};

/// The variants of a scene, or the scene as it is.
std::vector<ScenePart> parts_of(const fs::path& scene, const std::vector<std::string>& variants) {
    if (variants.empty()) return {{}};
    std::vector<ScenePart> parts;
    std::set<std::string> seen;
    std::set<std::string> used;
    std::map<std::string, int> numbers;
    for (const std::string& variant : variants) {
        if (!seen.insert(variant).second) continue;
        if (variant.find('\0') != std::string::npos)
            throw SceneError({scene.string(), {}},
                             fmt::format("the material variant '{}' cannot be asked for, since its name holds the "
                                         "character NUL, where words of a command line end; rename it",
                                         shown(variant)));
        const std::string part = file_part(variant);
        std::string suffix = "." + part;
        while (!used.insert(suffix).second)
            suffix = fmt::format(".{}-{}", part, ++numbers.try_emplace(part, 1).first->second);
        parts.push_back({variant, suffix, " variant " + variant});
    }
    return parts;
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
        for (fs::path& file : files_of_image(task.job.output, of_scene->second)) {
            if (!taken.insert(file).second)
                throw SceneError({task.job.scene.string(), {}},
                                 fmt::format("two files would be written to '{}'; render the scenes to different "
                                             "directories, or give one another name",
                                             file.string()));
            files.push_back(std::move(file));
        }
    }
    return files;
}

/// Throws ReplacedInput if one of `outputs` is read for an image. What does not exist yet is nobody's input: scenes are
/// looked at only if there is something to replace.
void require_scenes_kept(std::vector<fs::path> outputs, const std::vector<BatchTask>& tasks,
                         const BatchOptions& options) {
    std::error_code ignored;
    std::erase_if(outputs, [&](const fs::path& file) { return !fs::exists(file, ignored); });
    if (outputs.empty()) return;
    std::vector<fs::path> inputs = ColorConfig::environment_files();
    if (options.overrides.environment) inputs.emplace_back(*options.overrides.environment);
    const fs::path* last = nullptr;  // tasks of one scene are beside each other
    for (const BatchTask& task : tasks) {
        if (last == nullptr || *last != task.job.scene)
            for (fs::path& input : find_inputs(task.job.scene)) inputs.push_back(std::move(input));
        last = &task.job.scene;
    }
    require_inputs_kept("--output", outputs, inputs);
}

}  // namespace

std::vector<fs::path> batch_files(const fs::path& output) {
    return {output / "report.json", output / "index.html", output / "ledger.jsonl"};
}

std::vector<BatchTask> collect_tasks(const BatchOptions& options, const FindVariants& find_variants) {
    std::vector<BatchTask> tasks;
    for (const FoundScene& scene : find_scenes(options.roots)) {
        const auto variants = options.all_variants ? find_variants(scene.path) : std::vector<std::string>();
        for (const ScenePart& part : parts_of(scene.path, variants)) {
            const fs::path output = options.output / (scene.name + part.suffix + ".exr");
            for (ImageJob& job : image_jobs(scene.path, output, scene.name + part.label, options.overrides)) {
                job.variant = part.variant;
                const fs::path below = job.output.lexically_relative(options.output);
                tasks.push_back({std::move(job), output, (below.parent_path() / below.stem()).string()});
            }
        }
    }
    require_scenes_kept(files_of(tasks, options), tasks, options);
    return tasks;
}

}  // namespace etendue
