#include "app/up_to_date.h"

#include <algorithm>
#include <fstream>
#include <system_error>

#include <nlohmann/json.hpp>

namespace etendue {

namespace {

/// The settings hash of a finished render, or nothing useful: an unreadable or foreign file is no reason to fail.
std::string finished_hash(const std::filesystem::path& json_file) {
    std::ifstream in(json_file);
    const nlohmann::json json = nlohmann::json::parse(in, nullptr, false);
    if (!json.is_object() || !json.value("complete", nlohmann::json()).is_boolean() || !json["complete"].get<bool>())
        return {};
    const nlohmann::json hash = json.value("settings_hash", nlohmann::json());
    return hash.is_string() ? hash.get<std::string>() : std::string();
}

}  // namespace

bool is_up_to_date(const OutputPaths& output, const std::vector<std::filesystem::path>& inputs,
                   const std::string& hash) {
    namespace fs = std::filesystem;
    std::error_code error;
    fs::file_time_type oldest = fs::file_time_type::max();
    for (const fs::path& path : {output.exr, output.png, output.json}) {
        const fs::file_time_type time = fs::last_write_time(path, error);
        if (error) return false;
        oldest = std::min(oldest, time);
    }
    for (const fs::path& input : inputs) {
        const fs::file_time_type time = fs::last_write_time(input, error);
        if (error || time >= oldest) return false;
    }
    return finished_hash(output.json) == hash;
}

}  // namespace etendue
