// How a plan reads.
#include "batch/batch_plan.h"
#include "core/shown_text.h"
#include "session/progress_display.h"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace etendue {

namespace {

std::string format_estimate(const std::optional<double>& seconds) {
    return seconds ? format_duration(*seconds) : "?";
}

/// "3 of 5 images to render, about 2:10".
std::string counted(const BatchPlan& plan) {
    const PlanTotals sum = totals(plan);
    if (sum.stale == 0) return fmt::format("{} images, all up to date", plan.size());
    std::string text = fmt::format("{} of {} images to render", sum.stale, plan.size());
    if (sum.seconds) text += fmt::format(", about {}", format_duration(*sum.seconds));
    return text;
}

}  // namespace

std::string to_table(const BatchPlan& plan) {
    std::size_t name_width = 5;
    std::size_t reason_width = 3;
    for (const PlannedUnit& unit : plan) {
        name_width = std::max(name_width, shown_text(unit.task.job.name).size());
        reason_width = std::max(reason_width, shown_text(unit.reason).size());
    }
    const auto row = [&](const std::string& name, const std::string& plan_text, const std::string& why,
                         const std::string& time, const std::string& image) {
        return fmt::format("{:<{}}  {:<10}  {:<{}}  {:>9}  {}\n", name, name_width, plan_text, why, reason_width, time,
                           image);
    };
    std::string text = row("scene", "plan", "why", "estimate", "image");
    for (const PlannedUnit& unit : plan)
        text += row(shown_text(unit.task.job.name), unit.is_stale() ? "render" : "up to date",
                    unit.is_stale() ? shown_text(unit.reason) : "-",
                    unit.is_stale() ? format_estimate(unit.estimated_seconds) : "-",
                    shown_text(unit.task.job.output.string()));
    return text + counted(plan) + "\n";
}

std::string to_json(const BatchPlan& plan) {
    using Json = nlohmann::ordered_json;
    Json units = Json::array();
    for (const PlannedUnit& unit : plan) {
        const ImageJob& job = unit.task.job;
        units.push_back({{"name", job.name},
                         {"scene", job.scene.string()},
                         {"frame", job.frame ? Json(*job.frame) : Json()},
                         {"variant", job.variant ? Json(*job.variant) : Json()},
                         {"image", job.output.string()},
                         {"stale", unit.is_stale()},
                         {"reason", unit.is_stale() ? Json(unit.reason) : Json()},
                         {"estimated_seconds", unit.estimated_seconds ? Json(*unit.estimated_seconds) : Json()}});
    }
    const PlanTotals sum = totals(plan);
    const Json json{{"stale", sum.stale},
                    {"estimated_seconds", sum.seconds ? Json(*sum.seconds) : Json()},
                    {"units", std::move(units)}};
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string summary(const BatchPlan& plan) {
    constexpr std::size_t kMostReasons = 6;
    std::map<std::string, std::size_t> counts;
    for (const PlannedUnit& unit : plan)
        if (unit.is_stale()) ++counts[unit.reason];
    std::vector<std::pair<std::size_t, std::string>> reasons;
    for (const auto& [reason, count] : counts) reasons.emplace_back(count, reason);
    std::ranges::stable_sort(reasons, std::ranges::greater(), &std::pair<std::size_t, std::string>::first);
    std::string text = counted(plan);
    for (std::size_t i = 0; i < std::min(reasons.size(), kMostReasons); ++i)
        text += fmt::format("{}{} {}", i == 0 ? ": " : "; ", reasons[i].first, reasons[i].second);
    if (reasons.size() > kMostReasons) text += "; ...";
    return text;
}

}  // namespace etendue
