// From a path to a scene: which file, which settings, in which order, and what becomes of the problems.

#include "core/shown_text.h"
#include "loader/files.h"
#include "loader/loader.h"
#include "loader/named_files.h"
#include "loader/settings/apply_extras.h"
#include "loader/settings/lamp_notes.h"
#include "loader/settings/render_json.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <system_error>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

namespace fs = std::filesystem;

const SceneLoader* find_loader(const fs::path& file) {
    for (const auto& loader : scene_loaders()) {
        if (loader->can_load(file)) return loader.get();
    }
    return nullptr;
}

bool has_scene_extension(const fs::path& file) {
    const std::string extension = lower_extension(file);
    return extension == ".gltf" || extension == ".glb";
}

/// True if nothing has the name that `code` is about: it is gone, or a link that leads nowhere.
bool is_missing(const std::error_code& code) {
    return code == std::errc::no_such_file_or_directory || code == std::errc::not_a_directory ||
           code == std::errc::too_many_symbolic_link_levels;
}

/// True for a folder, such as one named after a model, with scenes somewhere in it.
bool holds_scenes(const fs::path& directory) {
    std::error_code code;
    for (fs::recursive_directory_iterator entry(directory, code), end; !code && entry != end; entry.increment(code))
        if (has_scene_extension(entry->path()) || entry->path().filename() == kSettingsName) return true;
    return false;
}

/// Returns the glTF files directly in `directory`, sorted; `code` says why it cannot be listed. A pipe, a folder or a
/// link to nothing counts if its name is "scene" or there is nothing else, so that loading it says what it is.
std::vector<fs::path> scene_files(const fs::path& directory, std::error_code& code) {
    std::vector<fs::path> files;
    std::vector<fs::path> others;
    for (fs::directory_iterator entry(directory, code), end; !code && entry != end; entry.increment(code)) {
        std::error_code ignored;
        if (!has_scene_extension(entry->path())) continue;
        if (entry->is_regular_file(ignored))
            files.push_back(entry->path());
        else if (!entry->is_directory(ignored) || !holds_scenes(entry->path()))
            others.push_back(entry->path());
    }
    const bool has_files = !files.empty();
    std::ranges::copy_if(others, std::back_inserter(files),
                         [&](const fs::path& other) { return !has_files || other.stem() == "scene"; });
    std::ranges::sort(files);
    return files;
}

/// True for a link to a directory that it lies in.
bool leads_up(const fs::path& link) {
    std::error_code code;
    const fs::path from = fs::canonical(link.parent_path(), code);
    const fs::path to = fs::canonical(link, code);
    return std::ranges::mismatch(to, from).in1 == to.end();
}

/// The scene file of `directory`: the one that `wanted` names, else scene.gltf or scene.glb, else the only one.
fs::path choose_scene_file(const fs::path& directory, const std::string& wanted, const SourceLocation& settings) {
    if (!wanted.empty()) {
        try {
            static_cast<void>(resolve_name(directory, wanted));
            return directory / wanted;
        } catch (const IoError& error) {
            throw SceneError({settings.file, "/scene"}, fmt::format("'{}': {}", wanted, error.what()));
        }
    }
    std::error_code code;
    const std::vector<fs::path> files = scene_files(directory, code);
    if (code) throw SceneError({directory.string(), {}}, "cannot be read: " + code.message());
    if (files.empty()) {
        std::vector<fs::path> below = find_scene_directories(directory);
        std::erase(below, directory);
        if (below.empty()) throw SceneError({directory.string(), {}}, "there is no glTF file in this directory");
        const std::string first = below.front().string();
        if (fs::exists(directory / kSettingsName, code))
            throw SceneError({(directory / kSettingsName).string(), {}},
                             fmt::format("this file belongs beside a glTF file, and there is none; scenes below, such "
                                         "as '{}', do not inherit it: move it to a scene, or give options instead",
                                         first));
        throw SceneError({directory.string(), {}},
                         fmt::format("there is no glTF file in this directory, but scenes are below it, such as '{}': "
                                     "give one of them, or all to 'etendue batch'",
                                     first));
    }
    fs::path chosen = files.front();
    if (files.size() > 1) {
        std::vector<fs::path> preferred;
        std::ranges::copy_if(files, std::back_inserter(preferred),
                             [](const fs::path& f) { return f.stem() == "scene"; });
        if (preferred.size() != 1) {
            std::string names;
            for (const fs::path& file : files) names += (names.empty() ? "" : ", ") + file.filename().string();
            throw SceneError(
                {directory.string(), {}},
                fmt::format("there are several glTF files ({}): name one with \"scene\" in {}, or give the "
                            "file itself",
                            names, kSettingsName));
        }
        chosen = preferred.front();
    }
    try {
        static_cast<void>(resolve_name(directory, chosen.filename().string()));
    } catch (const IoError& error) {
        throw SceneError({chosen.string(), {}}, error.what());
    }
    return chosen;
}

/// True if the settings are not meant for `file`, because they name another one.
bool is_for_another_file(const RenderJson& json, const fs::path& directory, const fs::path& file) {
    if (json.scene.empty()) return false;
    std::error_code code;
    return !fs::equivalent(directory / json.scene, file, code);
}

std::optional<RenderJson> read_given_settings(const std::string& given, ProblemList& problems) {
    if (given.empty()) return std::nullopt;
    return read_render_json({}, given, problems);
}

std::optional<RenderJson> read_settings(const fs::path& directory, const std::string& given, ProblemList& problems) {
    const fs::path file = directory / kSettingsName;
    std::error_code code;
    if (!fs::exists(file, code)) return read_given_settings(given, problems);
    try {
        static_cast<void>(resolve_name(directory, kSettingsName));
    } catch (const IoError& error) {
        throw SceneError({file.string(), {}}, error.what());
    }
    return read_render_json(file, given, problems);
}

/// The directory of the scene at `path`.
fs::path directory_of(const fs::path& path, bool is_directory) {
    if (is_directory) return path;
    return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

/// Says which camera was taken if nobody chose one of several.
void note_camera(const SceneDesc& scene, ProblemList& problems) {
    if (!scene.settings.camera.empty() || scene.cameras.size() < 2) return;
    constexpr std::size_t kMostNames = 8;
    const auto name_of = [&](const CameraDesc& camera) {
        // Of several nodes with one name, it names the first.
        const bool has_own_node = !camera.node.empty() && find_camera(scene, camera.node) == &camera;
        return shown(has_own_node ? camera.node : camera.name);
    };
    std::string others;
    for (std::size_t i = 1; i < std::min(scene.cameras.size(), kMostNames + 1); ++i) {
        others += fmt::format("{}'{}'", i == 1 ? "" : ", ", name_of(scene.cameras[i]));
    }
    if (scene.cameras.size() > kMostNames + 1) others += " and more";
    problems.note({scene.file.string(), "/cameras"},
                  fmt::format("the file has {} cameras, of which the first, '{}', is taken; --camera NAME takes "
                              "another: {}",
                              scene.cameras.size(), name_of(scene.cameras.front()), others));
}

void load_into(const fs::path& path, const LoadOptions& options, SceneDesc& scene, SweptSpace& swept,
               ProblemList& problems) {
    std::error_code code;
    const bool is_directory = fs::is_directory(path, code);
    if (!fs::exists(path, code)) {
        const bool is_unknown = code && code != std::errc::no_such_file_or_directory;
        throw SceneError({path.string(), {}},
                         is_unknown ? "cannot be read: " + code.message() : "there is no such file or directory");
    }

    scene.directory = directory_of(path, is_directory);
    scene.name = scene_name(path);
    std::optional<RenderJson> settings = read_settings(scene.directory, options.settings, problems);
    scene.file = is_directory ? choose_scene_file(path, settings ? settings->scene : "",
                                                  settings ? settings->location : SourceLocation{})
                              : path;
    if (settings && !is_directory && is_for_another_file(*settings, scene.directory, scene.file)) {
        problems.note(settings->location, fmt::format("ignored: it is for '{}'", settings->scene));
        // The ignored file is still listed as an input, so that no output replaces it.
        if (!settings->file.empty()) scene.inputs.push_back(settings->file);
        settings = read_given_settings(options.settings, problems);
    }

    const SceneLoader* loader = find_loader(scene.file);
    if (loader == nullptr) {
        throw SceneError({scene.file.string(), {}}, "the file's format is not known; glTF files are .gltf or .glb");
    }
    if (settings) scene.settings = settings->settings;
    scene.settings.frame = options.frame;
    if (options.adjust) options.adjust(scene.settings);
    swept = loader->load(scene.file, options, scene, problems);
    if (!scene.extras.empty()) settings = with_extras(settings.value_or(RenderJson()), scene, problems);
    const std::map<std::string, LightOverride> lights = settings ? settings->lights : decltype(lights)();
    note_bright_lamps(lights, scene, problems);
    if (settings) {
        if (!settings->file.empty()) scene.inputs.push_back(settings->file);
        apply_render_json(*settings, options.assets, scene, problems);
    }
    if (scene.instances.empty()) problems.warning({scene.file.string(), {}}, "the scene shows no surfaces");
    note_area_lamps(lights, scene, problems);
    note_camera(scene, problems);
}

void append(const ProblemList& from, ProblemList& to) {
    for (const Problem& problem : from.all()) to.add(problem);
}

}  // namespace

LoadedScene inspect_scene(const fs::path& path, const LoadOptions& options) {
    LoadedScene result;
    try {
        load_into(path, options, result.scene, result.swept, result.problems);
        leave_out_unreadable_images(result.scene);
        append(validate(result.scene), result.problems);
    } catch (const SceneError& error) {
        append(error.problems(), result.problems);
    } catch (const fs::filesystem_error& error) {
        result.problems.error({path.string(), {}}, error.what());
    }
    return result;
}

LoadedScene load_scene(const fs::path& path, const LoadOptions& options) {
    LoadedScene result = inspect_scene(path, options);
    if (result.problems.has_errors()) throw SceneError(result.problems);
    return result;
}

std::string scene_name(const fs::path& path) {
    const fs::path full = fs::absolute(path).lexically_normal();
    std::error_code code;
    if (!fs::is_directory(path, code)) return full.stem().string();
    return (full.has_filename() ? full.filename() : full.parent_path().filename()).string();
}

std::optional<RenderSettings> find_settings(const fs::path& path) {
    std::error_code code;
    const bool is_directory = fs::is_directory(path, code);
    const fs::path directory = directory_of(path, is_directory);
    ProblemList problems;
    try {
        const std::optional<RenderJson> settings = read_settings(directory, {}, problems);
        if (!settings || (!is_directory && is_for_another_file(*settings, directory, path))) return std::nullopt;
        return settings->settings;
    } catch (const SceneError&) {
        return std::nullopt;
    }
}

std::optional<FrameRange> find_frames(const fs::path& path) {
    const std::optional<RenderSettings> settings = find_settings(path);
    return settings ? settings->frames : std::nullopt;
}

std::vector<fs::path> find_inputs(const fs::path& path, std::span<const fs::path> assets) {
    std::error_code code;
    const bool is_directory = fs::is_directory(path, code);
    const fs::path directory = directory_of(path, is_directory);
    std::vector<fs::path> files = is_directory ? scene_files(path, code) : std::vector{path};
    files.push_back(directory / kSettingsName);
    for (std::size_t i = files.size(); i-- > 0;)
        for (const std::string& name : named_files(files[i])) {
            files.push_back(directory / name);
            for (const fs::path& from : assets) files.push_back(from / name);
        }
    return files;
}

std::vector<fs::path> find_scene_directories(const fs::path& root) {
    std::error_code code;
    if (!fs::is_directory(root, code)) throw SceneError({root.string(), {}}, "this is not a directory");

    std::vector<fs::path> found;
    std::set<fs::path> visited;  // as they are called without links, which may lead in circles
    std::vector<fs::path> pending{root};
    std::vector<fs::path> links;  // followed last, so that a directory goes by its own name where it has one here
    while (!pending.empty() || !links.empty()) {
        if (pending.empty()) {
            const auto next = std::ranges::min_element(links);
            pending.push_back(std::move(*next));
            links.erase(next);
        }
        const fs::path directory = std::move(pending.back());
        pending.pop_back();
        const fs::path called = fs::canonical(directory, code);
        if (!visited.insert(code ? directory : called).second) continue;
        const bool has_files = !scene_files(directory, code).empty();
        // Loading one that cannot be listed says so.
        bool is_scene = has_files || (code && !is_missing(code));
        is_scene = fs::exists(directory / kSettingsName, code) || is_scene;
        if (is_scene) found.push_back(directory);
        for (fs::directory_iterator entry(directory, code), end; !code && entry != end; entry.increment(code)) {
            std::error_code unknown;
            if (!entry->is_directory(unknown)) {
                if (unknown && !is_missing(unknown) && !is_scene) found.push_back(entry->path());
                continue;
            }
            std::error_code ignored;
            if (!entry->is_symlink(ignored))
                pending.push_back(entry->path());
            else if (!is_scene && !leads_up(entry->path()))  // a scene's own links lead to its files
                links.push_back(entry->path());
        }
    }
    std::ranges::sort(found);
    return found;
}

}  // namespace etendue
