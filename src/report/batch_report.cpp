#include "report/batch_report.h"

#include <algorithm>

namespace etendue {

namespace {

std::size_t& count_of(BatchTotals& totals, UnitOutcome outcome) {
    switch (outcome) {
        case UnitOutcome::Rendered:
            return totals.rendered;
        case UnitOutcome::UpToDate:
            return totals.up_to_date;
        case UnitOutcome::Failed:
            return totals.failed;
        case UnitOutcome::Interrupted:
            return totals.interrupted;
        case UnitOutcome::Running:
            return totals.running;
        case UnitOutcome::RunningElsewhere:
            return totals.running_elsewhere;
        case UnitOutcome::NotChosen:
            return totals.not_chosen;
        case UnitOutcome::NotStarted:
            break;
    }
    return totals.not_started;
}

}  // namespace

BatchTotals totals(const BatchReport& report) {
    BatchTotals sum;
    sum.units = report.units.size();
    for (const BatchUnit& unit : report.units) {
        ++count_of(sum, unit.outcome);
        if (!unit.warnings.empty()) ++sum.with_warnings;
        if (unit.outcome == UnitOutcome::NotStarted && unit.error == kNotTried) ++sum.not_tried;
        sum.peak_memory_bytes = std::max(sum.peak_memory_bytes, unit.peak_memory_bytes.value_or(0));
        if (unit.outcome != UnitOutcome::Rendered && unit.outcome != UnitOutcome::Interrupted) continue;
        sum.rays += unit.rays.value_or(0) - std::min(unit.rays_before, unit.rays.value_or(0));
        if (!unit.seconds) continue;
        sum.seconds.load += unit.seconds->load;
        sum.seconds.build += unit.seconds->build;
        sum.seconds.render += std::max(0.0, unit.seconds->render - unit.seconds_before);
        sum.seconds.write += unit.seconds->write;
        sum.seconds.denoise += unit.seconds->denoise;
    }
    return sum;
}

BatchReport of_chosen(BatchReport report) {
    std::erase_if(report.units, [](const BatchUnit& unit) { return !unit.is_chosen; });
    return report;
}

const char* outcome_name(UnitOutcome outcome) {
    switch (outcome) {
        case UnitOutcome::Rendered:
            return "rendered";
        case UnitOutcome::UpToDate:
            return "up to date";
        case UnitOutcome::Failed:
            return "failed";
        case UnitOutcome::Interrupted:
            return "interrupted";
        case UnitOutcome::Running:
            return "running";
        case UnitOutcome::RunningElsewhere:
            return "running elsewhere";
        case UnitOutcome::NotChosen:
            return "not chosen";
        case UnitOutcome::NotStarted:
            break;
    }
    return "not started";
}

const char* state_name(BatchState state) {
    switch (state) {
        case BatchState::Planning:
            return "planning";
        case BatchState::Running:
            return "running";
        case BatchState::Ended:
            break;
    }
    return "ended";
}

bool has_image(UnitOutcome outcome) {
    return outcome == UnitOutcome::Rendered || outcome == UnitOutcome::UpToDate || outcome == UnitOutcome::Interrupted;
}

}  // namespace etendue
