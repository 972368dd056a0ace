#include "app/batch_units.h"

#include "core/error.h"
#include "loader/loader.h"

#include <cctype>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

namespace fs = std::filesystem;

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
    std::string part = variant.substr(0, kMostBytes);
    for (char& c : part)
        if (c == '/' || c == '#' || std::iscntrl(static_cast<unsigned char>(c)) != 0) c = '_';
    return part;
}

struct ScenePart {
    std::optional<std::string> variant{};
    std::string suffix{};  ///< of the name of its images
    std::string label{};   ///< the same, for people
};

/// The variants of a scene, or the scene as it is.
std::vector<ScenePart> parts_of(const std::vector<std::string>& variants) {
    if (variants.empty()) return {{}};
    std::vector<ScenePart> parts;
    std::set<std::string> seen;
    std::set<std::string> used;
    std::map<std::string, int> numbers;
    for (const std::string& variant : variants) {
        if (!seen.insert(variant).second) continue;
        const std::string part = file_part(variant);
        std::string suffix = "." + part;
        while (!used.insert(suffix).second)
            suffix = fmt::format(".{}-{}", part, ++numbers.try_emplace(part, 1).first->second);
        parts.push_back({variant, suffix, " variant " + variant});
    }
    return parts;
}

}  // namespace

std::vector<BatchTask> collect_tasks(const BatchOptions& options, const FindVariants& find_variants) {
    std::vector<BatchTask> tasks;
    std::set<fs::path> taken;
    for (const FoundScene& scene : find_scenes(options.roots)) {
        const auto variants = options.all_variants ? find_variants(scene.path) : std::vector<std::string>();
        for (const ScenePart& part : parts_of(variants)) {
            const fs::path output = options.output / (scene.name + part.suffix + ".exr");
            for (ImageJob& job : image_jobs(scene.path, output, scene.name + part.label, options.overrides)) {
                job.variant = part.variant;
                if (!taken.insert(job.output).second || job.output == options.output / "report.exr")
                    throw SceneError(
                        {scene.path.string(), {}},
                        fmt::format("two files would be written to '{}'; render the scenes to different directories, "
                                    "or give one another name",
                                    OutputPaths::beside(job.output).json.string()));
                const fs::path below = job.output.lexically_relative(options.output);
                tasks.push_back({std::move(job), output, (below.parent_path() / below.stem()).string()});
            }
        }
    }
    return tasks;
}

}  // namespace etendue
