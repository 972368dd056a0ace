#include "session/up_to_date.h"

#include "core/content_hash.h"
#include "output/input_file_json.h"
#include "render/render.h"
#include "scene/canonical_settings.h"
#include "session/input_files.h"
#include "session/prepared_scene.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace etendue {

namespace {

namespace fs = std::filesystem;

/// The statistics beside an image; an unreadable or foreign file is no reason to fail, it is no object then.
nlohmann::json read_statistics(const fs::path& json_file) {
    std::ifstream in = open_regular_file(json_file);
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

std::optional<double> number_at(const nlohmann::json& json, const char* pointer) {
    const nlohmann::json::json_pointer place(pointer);
    if (!json.contains(place) || !json[place].is_number()) return std::nullopt;
    return json[place].get<double>();
}

/// How far the render of these statistics came when it was cut short.
Staleness cut_short(const nlohmann::json& statistics) {
    const double done = number_at(statistics, "/spp/done").value_or(0.0);
    const double requested = number_at(statistics, "/spp/requested").value_or(0.0);
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

/// Returns why `file`, which once had `bytes`, is damaged; empty if it is not. Other programs may have made it larger,
/// and a PNG smaller.
std::string damage_of(const fs::path& file, std::uintmax_t bytes) {
    std::error_code error;
    const std::uintmax_t now = fs::file_size(file, error);
    if (error || now >= bytes || is_whole_png(file)) return "";
    return fmt::format("{} is damaged: {} of {} bytes", file.filename().string(), now, bytes);
}

/// None if the statistics do not tell.
std::optional<std::vector<InputFile>> inputs_of(const nlohmann::json& statistics) try {
    const auto list = value_of<nlohmann::json>(statistics, "inputs", &nlohmann::json::is_array);
    if (!list) return std::nullopt;
    return list->get<std::vector<InputFile>>();
} catch (const nlohmann::json::exception&) {
    return std::nullopt;
}

/// Returns ": spp: 16 -> 32" if the statistics tell with which settings the image was made, and some of those that
/// `takes_part` is true for have changed.
std::string changes(const nlohmann::json& statistics, const RenderSettings& settings,
                    bool (*takes_part)(Decides decides)) try {
    const auto requested = value_of<nlohmann::json>(statistics, "requested_settings", &nlohmann::json::is_object);
    if (!requested) return "";
    // In the words of one writer of JSON.
    SettingTexts after = canonical_settings(settings, takes_part);
    for (auto& [pointer, text] : after) text = nlohmann::json::parse(text).dump();
    SettingTexts before = canonical_settings(RenderSettings(), takes_part);
    for (auto& [pointer, text] : before) {
        const auto was = requested->find(pointer);
        text = was != requested->end() ? was->dump() : nlohmann::json::parse(text).dump();
    }
    return fmt::format("{}{}", before == after ? "" : ": ", fmt::join(changed_settings(before, after), "; "));
} catch (const nlohmann::json::exception&) {
    return "";
}

bool is_end(const Setting& setting) {
    return setting.decides == Decides::End;
}

/// True for settings that say how the sums are shown, or what is told of them.
bool shows_sums(const Setting& setting) {
    return setting.decides == Decides::Display || setting.decides == Decides::Report;
}

/// Returns `settings` with those of which `is_meant` is true as the image of these statistics was asked for them; none
/// if they do not tell.
template <typename IsMeant>
std::optional<RenderSettings> as_made(const nlohmann::json& statistics, RenderSettings settings,
                                      const IsMeant& is_meant) {
    const auto requested = value_of<nlohmann::json>(statistics, "requested_settings", &nlohmann::json::is_object);
    if (!requested) return std::nullopt;
    for (const Setting& setting : settings_table()) {
        if (!is_meant(setting)) continue;
        SettingValue value = default_value(setting);
        if (const auto found = requested->find(setting.pointer); found != requested->end()) {
            if (found->is_boolean())
                value = found->get<bool>();
            else if (found->is_number_integer() && std::holds_alternative<std::int64_t>(value))
                value = found->get<std::int64_t>();
            else if (found->is_number())
                value = found->get<double>();
            else if (found->is_string())
                value = found->get<std::string>();
            else
                return std::nullopt;
        }
        if (problem_with(setting, value)) return std::nullopt;
        setting.place.write(settings, value);
    }
    return settings;
}

/// True if the complete image of these statistics, which was made with the settings `made`, is what a render of `asked`
/// would end with, or better; only when they end is different.
bool has_reached(const nlohmann::json& statistics, const RenderSettings& made, const RenderSettings& asked) {
    const auto is_adaptive = [](const RenderSettings& s) { return s.relative_error > 0.0 && s.adaptive; };
    const double done = number_at(statistics, "/spp/done").value_or(0.0);
    const double least = number_at(statistics, "/adaptive/least").value_or(done);
    // Every pixel has all samples, and no limit asks for more.
    if (done == asked.spp && least == done) return true;
    if (done > asked.spp || is_adaptive(made) != is_adaptive(asked)) return false;
    if (is_adaptive(made) && made.min_spp != asked.min_spp) return false;
    // A render ends before the pass that would exceed its time, which then is not quite over.
    const bool took_its_time = value_of<std::string>(statistics, "halt_reason", &nlohmann::json::is_string) ==
                               halt_reason_name(HaltReason::TimeLimit);
    const double seconds =
        std::max(took_its_time ? made.time_limit : 0.0, number_at(statistics, "/seconds/render/wall").value_or(0.0));
    if (asked.time_limit > 0.0 && seconds >= asked.time_limit) return true;
    const std::optional<double> error = number_at(statistics, "/estimated_relative_error");
    return asked.relative_error > 0.0 && error && *error <= asked.relative_error;
}

}  // namespace

std::optional<Staleness> why_unfinished(const OutputPaths& output) {
    std::error_code error;
    std::string missing;
    std::size_t count = 0;
    std::vector<fs::path> files{output.exr, output.json};
    if (!output.png.empty()) files.push_back(output.png);
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
    const nlohmann::json sizes = value_of<nlohmann::json>(statistics, "file_sizes", &nlohmann::json::is_object)
                                     .value_or(nlohmann::json::object());
    for (const auto& [name, bytes] : sizes.items()) {
        const fs::path file = output.json.parent_path() / fs::path(name).filename();
        if (!bytes.is_number_unsigned() || (output.png.empty() && file.extension() == ".png")) continue;
        if (const std::string damage = damage_of(file, bytes.get<std::uintmax_t>()); !damage.empty())
            return Staleness{.reason = damage, .is_unfinished = true};
    }
    return std::nullopt;
}

bool is_whole_png(const fs::path& file) {
    constexpr std::string_view kEnd("\0\0\0\0IEND\xae\x42\x60\x82", 12);
    std::ifstream in = open_regular_file(file);
    in.seekg(-static_cast<std::streamoff>(kEnd.size()), std::ios::end);
    std::string end(kEnd.size(), ' ');
    return in.read(end.data(), static_cast<std::streamsize>(end.size())) && end == kEnd;
}

std::vector<std::string> listed_layer_files(const OutputPaths& output) {
    return layer_files_of(read_statistics(output.json));
}

std::optional<StrategiesShown> listed_strategies_image(const OutputPaths& output) {
    const nlohmann::json statistics = read_statistics(output.json);
    const auto shown = value_of<nlohmann::json>(statistics, "strategies_image", &nlohmann::json::is_object);
    if (!shown) return std::nullopt;
    const auto file = value_of<std::string>(*shown, "file", &nlohmann::json::is_string);
    const auto longest = value_of<int>(*shown, "longest", &nlohmann::json::is_number_integer);
    const auto weighted = value_of<bool>(*shown, "weighted", &nlohmann::json::is_boolean);
    if (!file || !longest || !weighted) return std::nullopt;
    return StrategiesShown{*file, *longest, *weighted};
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

std::optional<Staleness> why_outdated(const OutputPaths& output, const SceneDesc& scene, PixelDepth depth) {
    const nlohmann::json statistics = read_statistics(output.json);
    std::set<std::string> known;
    for (const InputFile& file : inputs_of(statistics).value_or(std::vector<InputFile>())) known.insert(file.path);
    for (const fs::path& input : scene.inputs)
        if (!known.contains(input_name(input, scene.directory)))
            return Staleness{.reason = fmt::format("input {} is new", input.filename().string())};
    const auto hash = value_of<std::string>(statistics, "settings_hash", &nlohmann::json::is_string);
    if (hash == settings_hash(scene, depth)) return std::nullopt;
    Staleness stale{.reason = fmt::format("settings changed{}", changes(statistics, scene.settings, decides_files))};
    const auto is_of = [&](const std::optional<RenderSettings>& made) {
        return made && hash == settings_hash(scene, *made, depth);
    };
    const std::optional<RenderSettings> made = as_made(statistics, scene.settings, is_end);
    if (is_of(made) && has_reached(statistics, *made, scene.settings)) return std::nullopt;
    const auto decides_no_sums = [](const Setting& setting) { return is_end(setting) || shows_sums(setting); };
    if (is_of(made) || is_of(as_made(statistics, scene.settings, decides_no_sums)))
        stale.done = std::min(1.0, number_at(statistics, "/spp/done").value_or(0.0) / scene.settings.spp);
    return stale;
}

std::string changes_of_sums(const OutputPaths& output, const RenderSettings& settings) {
    return changes(read_statistics(output.json), settings,
                   [](Decides decides) { return decides_pixels(decides) || decides == Decides::Window; });
}

bool is_up_to_date(const OutputPaths& output, const fs::path& path, const SceneDesc& scene, PixelDepth depth) {
    return !why_unfinished(output) && !why_outdated(output, path) && !why_outdated(output, scene, depth);
}

}  // namespace etendue
