#include "batch/batch_table.h"

#include "core/shown_text.h"
#include "session/progress_display.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>

#include <fmt/format.h>

namespace etendue {

std::string to_table(const BatchReport& report, const std::string& output) {
    std::size_t width = 5;
    for (const BatchUnit& unit : report.units) width = std::max(width, shown_text(unit.name).size());
    std::string text = fmt::format("{:<{}}  {:<11}  {:>11}  {:>6}  {:>9}  {:>8}  {}\n", "scene", width, "result",
                                   "size", "spp", "time", "Mrays/s", "image");
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
        // A message of several lines would break the table; its first line is enough here, all were logged.
        text += shown_text(unit.outcome == UnitOutcome::Failed ? unit.error.substr(0, unit.error.find('\n'))
                                                               : (std::filesystem::path(output) / unit.image).string());
        text += '\n';
    }
    if (const std::size_t count = totals(report).not_started; count > 0)
        text += count == 1 ? "1 image was not started\n" : fmt::format("{} images were not started\n", count);
    return text;
}

}  // namespace etendue
