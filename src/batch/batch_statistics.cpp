#include "batch/batch_statistics.h"

#include "batch/json_lookup.h"
#include "core/content_hash.h"
#include "render/render.h"

#include <cstddef>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Returns the first warnings that the statistics list, and a line that counts the others.
std::vector<std::string> warnings_in(const nlohmann::json& statistics) {
    constexpr std::size_t kMost = 20;
    std::vector<std::string> warnings;
    const auto list = statistics.find("warnings");
    if (list == statistics.end() || !list->is_array()) return warnings;
    for (const nlohmann::json& warning : *list) {
        if (warnings.size() == kMost) break;
        if (warning.is_string()) warnings.push_back(warning.get<std::string>());
    }
    if (list->size() > kMost) warnings.push_back(fmt::format("and {} more", list->size() - kMost));
    return warnings;
}

/// Returns whether the image was finished before it had the error that was asked for.
bool misses_error(const BatchUnit& unit) {
    const bool is_finished = unit.halt_reason == halt_reason_name(HaltReason::SamplesDone) ||
                             unit.halt_reason == halt_reason_name(HaltReason::TimeLimit);
    if (!is_finished || !unit.relative_error_requested) return false;
    return !unit.relative_error || *unit.relative_error > *unit.relative_error_requested;
}

}  // namespace

void read_statistics(const std::filesystem::path& file, BatchUnit& unit) {
    std::ifstream in = open_regular_file(file);
    const nlohmann::json json = nlohmann::json::parse(in, nullptr, false);
    if (!json.is_object()) return;
    unit.width = number_at<int>(json, "/size/0").value_or(0);
    unit.height = number_at<int>(json, "/size/1").value_or(0);
    unit.spp = number_at<int>(json, "/spp/done").value_or(0);
    unit.spp_requested = number_at<int>(json, "/spp/requested").value_or(0);
    if (unit.camera.empty()) unit.camera = text_at(json, "/camera");
    unit.integrator = text_at(json, "/integrator");
    unit.halt_reason = text_at(json, "/halt_reason");
    unit.relative_error = number_at<double>(json, "/estimated_relative_error");
    unit.relative_error_requested = number_at<double>(json, "/settings/~1error");
    if (unit.relative_error_requested == 0.0) unit.relative_error_requested.reset();
    unit.warnings = warnings_in(json);
    if (misses_error(unit))
        unit.warnings.push_back(
            fmt::format("warning: the error {:g} was not reached: {}; {}", *unit.relative_error_requested,
                        unit.relative_error ? fmt::format("it is {:.3g}", *unit.relative_error) : "it is not known",
                        unit.halt_reason));
    unit.seconds = UnitSeconds{number_at<double>(json, "/seconds/load/wall").value_or(0.0),
                               number_at<double>(json, "/seconds/build/wall").value_or(0.0),
                               number_at<double>(json, "/seconds/render/wall").value_or(0.0),
                               number_at<double>(json, "/seconds/write/wall").value_or(0.0)};
    unit.seconds_before = number_at<double>(json, "/before/seconds").value_or(0.0);
    unit.rays_before = number_at<std::uint64_t>(json, "/before/rays").value_or(0);
    unit.rays = number_at<std::uint64_t>(json, "/rays/total");
    unit.rays_per_second = number_at<double>(json, "/rays_per_second");
    unit.peak_memory_bytes = number_at<std::uint64_t>(json, "/peak_memory_bytes");
}

}  // namespace etendue
