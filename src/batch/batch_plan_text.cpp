// How a plan reads.
#include "batch/batch_plan.h"
#include "core/shown_text.h"
#include "session/progress_display.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace etendue {

namespace {

std::string format_estimate(const std::optional<double>& seconds) {
    return seconds ? format_duration(*seconds) : "?";
}

/// "about 2:54", or "about 2:54 without denoising" or, if some have no estimate, "\u2265 2:54, 1 unknown"; empty if
/// nothing is known.
std::string format_time(const PlanTotals& sum) {
    const std::size_t known = sum.stale - sum.failing - sum.unknown;
    if (known == 0) return "";
    const std::string time = format_duration(sum.seconds) + (sum.lacks_denoising ? " without denoising" : "");
    if (sum.unknown == 0) return "about " + time;
    return fmt::format("\u2265 {}, {} unknown", time, sum.unknown);
}

std::string images(std::size_t count) {
    return fmt::format("{} image{}", count, count == 1 ? "" : "s");
}

/// Returns "; 1 will fail", or nothing if none will.
std::string failing(const BatchPlan& plan) {
    const std::size_t count = totals(plan).failing;
    return count > 0 ? fmt::format("; {} will fail", count) : "";
}

/// True for an image that this batch renders, as far as is known.
bool will_render(const PlannedUnit& unit) {
    return unit.is_stale() && !unit.is_running_elsewhere && unit.error.empty();
}

/// "3 of 5 images to render, about 2:10".
std::string counted(const BatchPlan& plan) {
    const PlanTotals sum = totals(plan);
    const std::string elsewhere =
        sum.elsewhere > 0 ? fmt::format("; {} rendered elsewhere", sum.elsewhere) : std::string();
    if (sum.stale == 0)
        return images(plan.size()) + (sum.elsewhere > 0 ? ", none to render" : ", all up to date") + elsewhere;
    std::string text = fmt::format("{} of {} to render", sum.stale - sum.failing, images(plan.size()));
    if (const std::string time = format_time(sum); !time.empty()) text += ", " + time;
    return text + elsewhere;
}

/// Holds the texts of one row, which are as wide as the widest of their column.
using PlanRow = std::vector<std::string>;

PlanRow row_of(const PlannedUnit& unit) {
    const ImageOutline& outline = unit.outline;
    const auto known = [](bool is_known, std::string text) { return is_known ? std::move(text) : std::string("-"); };
    return {shown_text(unit.task.job.name),
            !unit.is_stale()            ? "up to date"
            : unit.is_running_elsewhere ? "wait"
            : !unit.error.empty()       ? "will fail"
                                        : "render",
            unit.is_stale() ? shown_text(unit.reason) : "-",
            known(outline.width > 0, fmt::format("{}x{}", outline.width, outline.height)),
            known(outline.spp > 0, fmt::format("{}", outline.spp)),
            known(!outline.integrator.empty(), shown_text(outline.integrator)),
            known(!outline.camera.empty(), shown_text(outline.camera)),
            unit.is_stale() && unit.error.empty() ? format_estimate(unit.estimated_seconds) : "-",
            shown_text(unit.task.job.output.string())};
}

}  // namespace

std::string to_table(const BatchPlan& plan) {
    std::vector<PlanRow> rows{{"scene", "plan", "why", "size", "spp", "integrator", "camera", "estimate", "image"}};
    rows.reserve(plan.size() + 1);
    for (const PlannedUnit& unit : plan) rows.push_back(row_of(unit));
    std::vector<std::size_t> widths(rows.front().size());
    for (const PlanRow& row : rows)
        for (std::size_t column = 0; column < row.size(); ++column)
            widths[column] = std::max(widths[column], row[column].size());
    std::string text;
    for (const PlanRow& row : rows) {
        for (std::size_t column = 0; column + 1 < row.size(); ++column)
            text += fmt::format("{:<{}}  ", row[column], widths[column]);
        text += row.back() + "\n";
    }
    return text + failures(plan) + warnings(plan) + replacements(plan) + counted(plan) + failing(plan) + "\n";
}

std::string failures(const BatchPlan& plan) {
    using Failure = std::pair<std::string, std::string>;  // scene and error
    std::vector<std::pair<Failure, std::size_t>> failures;
    for (const PlannedUnit& unit : plan) {
        if (!unit.is_stale() || unit.is_running_elsewhere || unit.error.empty()) continue;
        const Failure failure{unit.task.job.scene.string(), unit.error};
        auto found = std::ranges::find(failures, failure, &std::pair<Failure, std::size_t>::first);
        if (found == failures.end()) found = failures.insert(failures.end(), {failure, 0});
        ++found->second;
    }
    std::string text;
    for (const auto& [failure, count] : failures) {
        text += fmt::format("{}: {} will fail\n", shown_text(failure.first), images(count));
        std::istringstream lines(failure.second);
        for (std::string line; std::getline(lines, line);) text += "  " + shown_text(line) + "\n";
    }
    return text;
}

std::string warnings(const BatchPlan& plan) {
    std::set<std::pair<std::string, std::string>> said;  // scene and warning
    std::string text;
    for (const PlannedUnit& unit : plan) {
        if (!will_render(unit)) continue;
        const std::string scene = unit.task.job.scene.string();
        for (const std::string& warning : unit.warnings)
            if (said.emplace(scene, warning).second)
                text += fmt::format("{}: {}\n", shown_text(scene), shown_text(warning));
    }
    return text;
}

std::string replacements(const BatchPlan& plan) {
    const auto counted_as = [&](bool PlannedUnit::*loses, const char* one, const char* several) {
        const auto count =
            std::ranges::count_if(plan, [&](const PlannedUnit& unit) { return will_render(unit) && unit.*loses; });
        if (count == 0) return std::string();
        return fmt::format("{} finished image{} will be replaced by {}\n", count, count == 1 ? "" : "s",
                           count == 1 ? one : several);
    };
    return counted_as(&PlannedUnit::loses_samples, "one with fewer samples", "ones with fewer samples") +
           counted_as(&PlannedUnit::loses_pixels, "a smaller one", "smaller ones");
}

std::string to_json(const BatchPlan& plan) {
    using Json = nlohmann::ordered_json;
    const auto text_or_null = [](const std::string& text) { return text.empty() ? Json() : Json(text); };
    const auto number_or_null = [](int number) { return number > 0 ? Json(number) : Json(); };
    Json units = Json::array();
    for (const PlannedUnit& unit : plan) {
        const ImageJob& job = unit.task.job;
        units.push_back({{"unit", unit.task.id},
                         {"name", job.name},
                         {"scene", job.scene.string()},
                         {"frame", job.frame ? Json(*job.frame) : Json()},
                         {"variant", job.variant ? Json(*job.variant) : Json()},
                         {"camera", text_or_null(unit.outline.camera)},
                         {"image", job.output.string()},
                         {"stale", unit.is_stale()},
                         {"running_elsewhere", unit.is_running_elsewhere},
                         {"reason", text_or_null(unit.reason)},
                         {"error", text_or_null(unit.error)},
                         {"warnings", unit.warnings},
                         {"width", number_or_null(unit.outline.width)},
                         {"height", number_or_null(unit.outline.height)},
                         {"spp", number_or_null(unit.outline.spp)},
                         {"integrator", text_or_null(unit.outline.integrator)},
                         {"estimated_seconds", unit.estimated_seconds ? Json(*unit.estimated_seconds) : Json()}});
    }
    const PlanTotals sum = totals(plan);
    const Json json{
        {"stale", sum.stale},           {"elsewhere", sum.elsewhere},
        {"failing", sum.failing},       {"unknown", sum.unknown},
        {"known_seconds", sum.seconds}, {"estimated_seconds", sum.unknown == 0 ? Json(sum.seconds) : Json()},
        {"units", std::move(units)}};
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string summary(const BatchPlan& plan) {
    constexpr std::size_t kMostReasons = 6;
    std::map<std::string, std::size_t> counts;
    for (const PlannedUnit& unit : plan)
        if (will_render(unit)) ++counts[unit.reason];
    std::vector<std::pair<std::size_t, std::string>> reasons;
    reasons.reserve(counts.size());
    for (const auto& [reason, count] : counts) reasons.emplace_back(count, reason);
    std::ranges::stable_sort(reasons, std::ranges::greater(), &std::pair<std::size_t, std::string>::first);
    std::string text = counted(plan);
    for (std::size_t i = 0; i < std::min(reasons.size(), kMostReasons); ++i)
        text += fmt::format("{}{} {}", i == 0 ? ": " : "; ", reasons[i].first, reasons[i].second);
    if (reasons.size() > kMostReasons) text += "; ...";
    return text + failing(plan);
}

}  // namespace etendue
