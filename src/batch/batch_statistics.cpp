#include "batch/batch_statistics.h"

#include "batch/json_lookup.h"
#include "core/content_hash.h"

#include <fstream>

namespace etendue {

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
