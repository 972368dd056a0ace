#include "report/accelerator_report.h"
#include "report/human_units.h"
#include "report/text_table.h"

#include <cmath>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Writes a mean of counts; "-" for what is not known.
std::string mean_count(double value) {
    return std::isfinite(value) ? fmt::format("{:.1f}", value) : "-";
}

std::string count_or_none(std::uint64_t count) {
    return count > 0 ? human_count(static_cast<double>(count)) : "-";
}

std::vector<std::string> traced_cells(const TracedRays& traced) {
    return {human_count(traced.rays_per_second), mean_count(traced.nodes), mean_count(traced.triangles)};
}

}  // namespace

std::string to_table(const AcceleratorReport& report) {
    std::vector<std::vector<std::string>> built{
        {"accelerator", "triangles", "build", "size", "nodes", "references", "depth"}};
    std::vector<std::vector<std::string>> traced{
        {"accelerator", "rays", "traced", "rays/s", "nodes/ray", "triangles/ray", "ties", "differ"}};
    for (const AcceleratorMeasure& measure : report.measures) {
        built.push_back({measure.name, count_or_none(measure.triangles), human_seconds(measure.build_seconds),
                         human_bytes(static_cast<double>(measure.bytes)), count_or_none(measure.nodes),
                         count_or_none(measure.references), measure.depth > 0 ? std::to_string(measure.depth) : "-"});
        for (const TracedKind& kind : measure.kinds) {
            std::vector<std::string> row{measure.name, kind.kind, count_or_none(kind.traced.rays)};
            for (std::string& cell : traced_cells(kind.traced)) row.push_back(std::move(cell));
            row.push_back(std::to_string(kind.ties));
            row.push_back(std::to_string(kind.differ));
            traced.push_back(std::move(row));
        }
    }
    std::string text = aligned(built) + '\n' + aligned(traced);
    text += wrapped(
        "rays/s: of one thread, one ray after the other, the same rays for all; nodes and triangles: boxes or cells "
        "that a ray goes into, and triangles that it is tested against, on average; ties: other triangles than "
        "Embree's, as far away; differ: "
        "other hits than Embree's",
        2);
    if (report.growth.empty()) return text;
    std::vector<std::vector<std::string>> growth{
        {"accelerator", "triangles", "build", "size", "rays/s", "nodes/ray", "triangles/ray"}};
    for (const GrowthPoint& point : report.growth) {
        std::vector<std::string> row{point.name, count_or_none(point.triangles), human_seconds(point.build_seconds),
                                     human_bytes(static_cast<double>(point.bytes))};
        for (std::string& cell : traced_cells(point.traced)) row.push_back(std::move(cell));
        growth.push_back(std::move(row));
    }
    return text + '\n' + aligned(growth);
}

}  // namespace etendue
