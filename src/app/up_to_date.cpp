#include "app/up_to_date.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace etendue {

namespace {

namespace fs = std::filesystem;

/// The statistics beside an image; an unreadable or foreign file is no reason to fail, it is no object then.
nlohmann::json read_statistics(const fs::path& json_file) {
    std::ifstream in(json_file);
    return nlohmann::json::parse(in, nullptr, false);
}

/// Of a file of statistics, what stands under `key` if it is a `Value`.
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
    return std::nullopt;
}

std::optional<Staleness> why_outdated(const OutputPaths& output, const std::vector<fs::path>& inputs,
                                      const std::string& hash) {
    std::error_code error;
    fs::file_time_type oldest = fs::file_time_type::max();
    for (const fs::path& path : {output.exr, output.png, output.json}) {
        const fs::file_time_type time = fs::last_write_time(path, error);
        if (error) return Staleness{.reason = path.filename().string() + " is missing", .is_unfinished = true};
        oldest = std::min(oldest, time);
    }
    for (const fs::path& input : inputs) {
        const fs::file_time_type time = fs::last_write_time(input, error);
        if (error) return Staleness{.reason = fmt::format("input {} is missing", input.filename().string())};
        if (time >= oldest) return Staleness{.reason = fmt::format("input {} is newer", input.filename().string())};
    }
    const auto finished =
        value_of<std::string>(read_statistics(output.json), "settings_hash", &nlohmann::json::is_string);
    if (finished != hash) return Staleness{.reason = "settings changed"};
    return std::nullopt;
}

bool is_up_to_date(const OutputPaths& output, const std::vector<fs::path>& inputs, const std::string& hash) {
    return !why_unfinished(output) && !why_outdated(output, inputs, hash);
}

}  // namespace etendue
