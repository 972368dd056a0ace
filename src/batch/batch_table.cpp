#include "batch/batch_table.h"

#include "core/shown_text.h"
#include "session/progress_display.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace etendue {

namespace {

/// Returns "0.034/0.01", the error that was reached and the one that was asked for; "-" if none was.
std::string error_text(const BatchUnit& unit) {
    if (!unit.relative_error_requested) return "-";
    const std::string reached = unit.relative_error ? fmt::format("{:.3g}", *unit.relative_error) : "?";
    return fmt::format("{}/{:g}", reached, *unit.relative_error_requested);
}

/// Returns "4 images were not tried, as their scene failed", or `one` for one image, with the end of the line; nothing
/// for none.
std::string left_line(std::size_t count, const char* one, const char* several) {
    if (count == 0) return "";
    return count == 1 ? fmt::format("1 image was {}\n", one) : fmt::format("{} images were {}\n", count, several);
}

/// Returns "7 rendered, 1 failed in 2:22; 2 with warnings; out/index.html" with the end of the line.
std::string total_line(const BatchReport& report, const std::string& output) {
    const BatchTotals sum = totals(report);
    std::vector<std::string> parts;
    const auto add = [&parts](std::size_t count, const char* what) {
        if (count > 0) parts.push_back(fmt::format("{} {}", count, what));
    };
    add(sum.rendered, "rendered");
    add(sum.up_to_date, "up to date");
    add(sum.failed, "failed");
    add(sum.interrupted, "interrupted");
    add(sum.running_elsewhere, "running elsewhere");
    if (parts.empty()) parts.emplace_back("0 rendered");
    const std::string warned = sum.with_warnings > 0 ? fmt::format("; {} with warnings", sum.with_warnings) : "";
    return fmt::format("{} in {}{}; {}\n", fmt::join(parts, ", "), format_duration(report.seconds), warned,
                       shown_text((std::filesystem::path(output) / "index.html").string()));
}

}  // namespace

std::string to_table(const BatchReport& report, const std::string& output) {
    std::size_t width = 5;
    for (const BatchUnit& unit : report.units) width = std::max(width, shown_text(unit.name).size());
    const bool has_errors = std::ranges::any_of(
        report.units, [](const BatchUnit& unit) { return unit.relative_error_requested.has_value(); });
    const auto error_column = [&](const std::string& text) {
        return has_errors ? fmt::format("{:>14}  ", text) : std::string();
    };
    std::string text = fmt::format("{:<{}}  {:<11}  {:>11}  {:>6}  {:>9}  {:>8}  {}{}\n", "scene", width, "result",
                                   "size", "spp", "time", "Mrays/s", error_column("error"), "image");
    for (const BatchUnit& unit : report.units) {
        if (unit.outcome == UnitOutcome::NotStarted) continue;
        text += fmt::format("{:<{}}  {:<11}  ", shown_text(unit.name), width, outcome_name(unit.outcome));
        const bool has_numbers = unit.outcome != UnitOutcome::Failed && unit.width > 0 && unit.seconds;
        if (has_numbers)
            text +=
                fmt::format("{:>11}  {:>6}  {:>9}  {:>8.1f}  ", fmt::format("{}x{}", unit.width, unit.height), unit.spp,
                            format_duration(unit.seconds->total()), unit.rays_per_second.value_or(0.0) * 1e-6);
        else
            text += fmt::format("{:>11}  {:>6}  {:>9}  {:>8}  ", "-", "-", "-", "-");
        text += error_column(error_text(unit));
        // A message of several lines would break the table; its first line is enough here, all were logged.
        text += shown_text(unit.outcome == UnitOutcome::Failed ? unit.error.substr(0, unit.error.find('\n'))
                                                               : (std::filesystem::path(output) / unit.image).string());
        text += '\n';
    }
    const BatchTotals sum = totals(report);
    return text + left_line(sum.not_tried, "not tried, as its scene failed", "not tried, as their scene failed") +
           left_line(sum.not_started - sum.not_tried, "not started", "not started") + total_line(report, output);
}

}  // namespace etendue
