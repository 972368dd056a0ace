#include "batch/batch_statistics.h"

#include <fstream>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

namespace etendue {

namespace {

using Json = nlohmann::json;

/// Returns the number at `pointer`; none if there is something else.
template <typename Number>
std::optional<Number> number_at(const Json& json, const char* pointer) {
    const Json::json_pointer place(pointer);
    if (!json.contains(place) || !json[place].is_number()) return std::nullopt;
    return json[place].get<Number>();
}

std::string text_at(const Json& json, const char* pointer) {
    const Json::json_pointer place(pointer);
    return json.contains(place) && json[place].is_string() ? json[place].get<std::string>() : std::string();
}

}  // namespace

void read_statistics(const std::filesystem::path& file, BatchUnit& unit) {
    std::ifstream in(file);
    const Json json = Json::parse(in, nullptr, false);
    if (!json.is_object()) return;
    unit.width = number_at<int>(json, "/size/0").value_or(0);
    unit.height = number_at<int>(json, "/size/1").value_or(0);
    unit.spp = number_at<int>(json, "/spp/done").value_or(0);
    unit.spp_requested = number_at<int>(json, "/spp/requested").value_or(0);
    unit.integrator = text_at(json, "/integrator");
    unit.halt_reason = text_at(json, "/halt_reason");
    unit.seconds = UnitSeconds{number_at<double>(json, "/seconds/load/wall").value_or(0.0),
                               number_at<double>(json, "/seconds/build/wall").value_or(0.0),
                               number_at<double>(json, "/seconds/render/wall").value_or(0.0),
                               number_at<double>(json, "/seconds/write/wall").value_or(0.0)};
    unit.rays = number_at<std::uint64_t>(json, "/rays/total");
    unit.rays_per_second = number_at<double>(json, "/rays_per_second");
    unit.peak_memory_bytes = number_at<std::uint64_t>(json, "/peak_memory_bytes");
}

}  // namespace etendue
