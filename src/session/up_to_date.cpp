#include "session/up_to_date.h"

#include "output/input_file_json.h"
#include "scene/canonical_settings.h"
#include "session/input_files.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <set>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace etendue {

namespace {

namespace fs = std::filesystem;

/// The statistics beside an image; an unreadable or foreign file is no reason to fail, it is no object then.
nlohmann::json read_statistics(const fs::path& json_file) {
    std::ifstream in(json_file);
    return nlohmann::json::parse(in, nullptr, false);
}

/// Returns the value under `key` in the statistics `json` if that value is a `Value`, else nothing.
template <typename Value>
std::optional<Value> value_of(const nlohmann::json& json, const char* key, bool (nlohmann::json::*is_value)() const) {
    if (!json.is_object()) return std::nullopt;
    const auto found = json.find(key);
    if (found == json.end() || !((*found).*is_value)()) return std::nullopt;
    return found->template get<Value>();
}

/// How far the render of these statistics came when it was cut short.
Staleness cut_short(const nlohmann::json& statistics) {
    const auto spp = statistics.is_object() ? statistics.value("spp", nlohmann::json()) : nlohmann::json();
    const double done = value_of<double>(spp, "done", &nlohmann::json::is_number).value_or(0.0);
    const double requested = value_of<double>(spp, "requested", &nlohmann::json::is_number).value_or(0.0);
    if (!(done >= 0.0 && requested >= 1.0)) return {.reason = "was not finished", .is_unfinished = true};
    return {.reason = fmt::format("was interrupted at {} of {} spp", done, requested),
            .is_unfinished = true,
            .done = std::min(done / requested, 1.0)};
}

std::vector<std::string> layer_files_of(const nlohmann::json& statistics) {
    std::vector<std::string> names;
    const auto layers = value_of<nlohmann::json>(statistics, "layer_files", &nlohmann::json::is_array);
    for (const nlohmann::json& layer : layers.value_or(nlohmann::json::array()))
        if (layer.is_string()) names.push_back(fs::path(layer.get<std::string>()).filename().string());
    return names;
}

/// None if the statistics do not tell.
std::optional<std::vector<InputFile>> inputs_of(const nlohmann::json& statistics) try {
    const auto list = value_of<nlohmann::json>(statistics, "inputs", &nlohmann::json::is_array);
    if (!list) return std::nullopt;
    return list->get<std::vector<InputFile>>();
} catch (const nlohmann::json::exception&) {
    return std::nullopt;
}

/// Returns ": spp: 16 -> 32" if the statistics tell with which settings the image was made, and some have changed.
std::string changes(const nlohmann::json& statistics, const RenderSettings& settings) try {
    const auto requested = value_of<nlohmann::json>(statistics, "requested_settings", &nlohmann::json::is_object);
    if (!requested) return "";
    // In the words of one writer of JSON.
    SettingTexts after = canonical_settings(settings, decides_files);
    for (auto& [pointer, text] : after) text = nlohmann::json::parse(text).dump();
    SettingTexts before = canonical_settings(RenderSettings(), decides_files);
    for (auto& [pointer, text] : before) {
        const auto was = requested->find(pointer);
        text = was != requested->end() ? was->dump() : nlohmann::json::parse(text).dump();
    }
    return fmt::format("{}{}", before == after ? "" : ": ", fmt::join(changed_settings(before, after), "; "));
} catch (const nlohmann::json::exception&) {
    return "";
}

}  // namespace

std::optional<Staleness> why_unfinished(const OutputPaths& output) {
    std::error_code error;
    std::string missing;
    std::size_t count = 0;
    const std::array<fs::path, 3> files{output.exr, output.png, output.json};
    for (const fs::path& path : files) {
        if (fs::exists(path, error)) continue;
        missing = path.filename().string();
        ++count;
    }
    if (count == files.size()) return Staleness{.reason = "never rendered", .is_unfinished = true};
    if (count > 0) return Staleness{.reason = missing + " is missing", .is_unfinished = true};
    const nlohmann::json statistics = read_statistics(output.json);
    if (value_of<bool>(statistics, "complete", &nlohmann::json::is_boolean) != true) return cut_short(statistics);
    for (const std::string& name : layer_files_of(statistics))
        if (!fs::exists(output.json.parent_path() / name, error))
            return Staleness{.reason = name + " is missing", .is_unfinished = true};
    return std::nullopt;
}

std::vector<std::string> listed_layer_files(const OutputPaths& output) {
    return layer_files_of(read_statistics(output.json));
}

std::optional<Staleness> why_outdated(const OutputPaths& output, const fs::path& scene) {
    const auto files = inputs_of(read_statistics(output.json));
    if (!files) return Staleness{.reason = "its inputs are not known"};
    std::error_code error;
    const fs::path directory = fs::is_directory(scene, error) ? scene : scene.parent_path();
    for (const InputFile& file : *files)
        if (const auto change = what_changed(file, directory)) return Staleness{.reason = *change};
    return std::nullopt;
}

std::optional<Staleness> why_outdated(const OutputPaths& output, const SceneDesc& scene, const std::string& hash) {
    const nlohmann::json statistics = read_statistics(output.json);
    std::set<std::string> known;
    for (const InputFile& file : inputs_of(statistics).value_or(std::vector<InputFile>())) known.insert(file.path);
    for (const fs::path& input : scene.inputs)
        if (!known.contains(input_name(input, scene.directory)))
            return Staleness{.reason = fmt::format("input {} is new", input.filename().string())};
    if (value_of<std::string>(statistics, "settings_hash", &nlohmann::json::is_string) != hash)
        return Staleness{.reason = fmt::format("settings changed{}", changes(statistics, scene.settings))};
    return std::nullopt;
}

bool is_up_to_date(const OutputPaths& output, const fs::path& path, const SceneDesc& scene, const std::string& hash) {
    return !why_unfinished(output) && !why_outdated(output, path) && !why_outdated(output, scene, hash);
}

}  // namespace etendue
