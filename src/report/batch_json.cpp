#include "report/batch_report.h"
#include "report/json_values.h"

#include <utility>

#include <nlohmann/json.hpp>

namespace etendue {

namespace {

/// Writes numbers that are not finite as null.
using Json = nlohmann::ordered_json;

constexpr int kBatchFormat = 1;

Json positive(int number) {
    return number > 0 ? Json(number) : Json();
}

Json batch_object(const UnitSeconds& seconds) {
    return {{"load", seconds.load},   {"build", seconds.build},     {"render", seconds.render},
            {"write", seconds.write}, {"denoise", seconds.denoise}, {"total", seconds.total()}};
}

Json batch_object(const BatchTotals& sum) {
    return {{"units", sum.units},
            {"rendered", sum.rendered},
            {"up_to_date", sum.up_to_date},
            {"failed", sum.failed},
            {"interrupted", sum.interrupted},
            {"running", sum.running},
            {"running_elsewhere", sum.running_elsewhere},
            {"not_started", sum.not_started},
            {"not_chosen", sum.not_chosen},
            {"not_tried", sum.not_tried},
            {"with_warnings", sum.with_warnings},
            {"seconds", batch_object(sum.seconds)},
            {"rays", sum.rays},
            {"peak_memory_bytes", sum.peak_memory_bytes}};
}

Json batch_object(const BatchUnit& unit) {
    return {{"unit", unit.id},
            {"name", unit.name},
            {"scene", unit.scene},
            {"frame", known(unit.frame)},
            {"variant", known(unit.variant)},
            {"camera", known(unit.camera)},
            {"image", unit.image},
            {"preview", known(unit.preview)},
            {"outcome", outcome_name(unit.outcome)},
            {"chosen", unit.is_chosen},
            {"reason", known(unit.reason)},
            {"error", known(unit.error)},
            {"signal", known(unit.signal)},
            {"attempts", unit.attempts},
            {"host", known(unit.host)},
            {"log", unit.log},
            {"warnings", unit.warnings},
            {"width", positive(unit.width)},
            {"height", positive(unit.height)},
            {"spp", positive(unit.spp)},
            {"spp_requested", positive(unit.spp_requested)},
            {"fraction", known(unit.fraction)},
            {"seconds_left", known(unit.seconds_left)},
            {"integrator", known(unit.integrator)},
            {"halt_reason", known(unit.halt_reason)},
            {"relative_error", known(unit.relative_error)},
            {"relative_error_requested", known(unit.relative_error_requested)},
            {"seconds", unit.seconds ? batch_object(*unit.seconds) : Json()},
            {"seconds_before", unit.seconds_before},
            {"estimated_seconds", known(unit.estimated_seconds)},
            {"rays", known(unit.rays)},
            {"rays_per_second", known(unit.rays_per_second)},
            {"peak_memory_bytes", known(unit.peak_memory_bytes)}};
}

}  // namespace

std::string to_json(const BatchReport& report) {
    Json units = Json::array();
    for (const BatchUnit& unit : report.units) units.push_back(batch_object(unit));
    const Json json{{"format", kBatchFormat},
                    {"title", report.title},
                    {"output_directory", report.output_directory},
                    {"program", report.program},
                    {"command", report.command},
                    {"started", known(report.started)},
                    {"ended", known(report.ended)},
                    {"state", state_name(report.state)},
                    {"written", known(report.written)},
                    {"seconds", report.seconds},
                    {"seconds_left", known(report.seconds_left)},
                    {"host", report.host},
                    {"threads", positive(report.threads)},
                    {"jobs", report.jobs},
                    {"interrupted", report.interrupted},
                    {"totals", batch_object(totals(report))},
                    {"units", std::move(units)}};
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace etendue
