#include "batch/batch_plan.h"

#include "batch/batch_child.h"
#include "session/checkpoint_files.h"
#include "session/interrupt.h"
#include "session/prepared_scene.h"
#include "session/up_to_date.h"

#include <exception>
#include <utility>

#include <sys/stat.h>

namespace etendue {

namespace {

/// The reason of an image that is not whole, with what is known of its past.
void describe_unfinished(PlannedUnit& unit, const Staleness& stale, const LedgerHistory& history) {
    const LedgerHistory::Entry* const last = history.find(unit.task.id);
    unit.reason = stale.reason;
    if (last != nullptr && last->kind == LedgerEventKind::UnitFailed) unit.reason = "failed last time";
    if (last != nullptr && last->kind == LedgerEventKind::UnitNotTried)
        unit.reason = "was not tried last time, as its scene was invalid";
    if (!CheckpointFiles(unit.task.job.output).exist()) return;
    if (unit.reason == "never rendered") unit.reason = "was interrupted";
    unit.reason += ", goes on from a checkpoint";
    unit.done = stale.done;
}

}  // namespace

FileStamp FileStamp::of(const std::filesystem::path& path) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0) return {};
    return {status.st_ino, status.st_mtim.tv_sec, status.st_mtim.tv_nsec};
}

void examine(PlannedUnit& unit, const BatchOptions& options, bool force, const LedgerHistory& history) {
    const OutputPaths output = OutputPaths::beside(unit.task.job.output);
    unit.seen = FileStamp::of(output.json);
    unit.reason.clear();
    unit.done = 0.0;
    if (const auto stale = why_unfinished(output)) {
        describe_unfinished(unit, *stale, history);
    } else if (force) {
        unit.reason = kForced;
    } else if (const auto outdated = why_outdated(output, unit.task.job.scene)) {
        unit.reason = outdated->reason;
    } else {
        try {
            // Of files that were rendered before: what might crash a process has had its chance to crash another one.
            const SettingsOverrides overrides = overrides_of(unit.task.job, options.overrides);
            const PreparedScene prepared = prepare_scene(unit.task.job.scene, overrides);
            const std::string hash = settings_hash(prepared.scene, overrides.depth);
            if (const auto changed = why_outdated(output, prepared.scene, hash)) unit.reason = changed->reason;
        } catch (const std::exception&) {
            unit.reason = "the scene cannot be loaded";
        }
    }
}

BatchPlan make_plan(std::vector<BatchTask> tasks, const BatchOptions& options, const LedgerHistory& history,
                    const PlanProgress& progress) {
    BatchPlan plan;
    plan.reserve(tasks.size());
    const std::size_t count = tasks.size();
    std::filesystem::path probed_scene;
    std::optional<double> seconds;
    for (BatchTask& task : tasks) {
        if (interrupt_requested()) break;
        progress(task.job.name, plan.size(), count);
        PlannedUnit& unit = plan.emplace_back(PlannedUnit{.task = std::move(task)});
        examine(unit, options, options.force, history);
        if (!unit.is_stale() || options.no_probe) continue;
        if (unit.task.job.scene != probed_scene) {
            probed_scene = unit.task.job.scene;
            seconds = probe_in_child(unit.task, options);
        }
        if (seconds) unit.estimated_seconds = *seconds * (1.0 - unit.done);
    }
    return plan;
}

PlanTotals totals(const BatchPlan& plan) {
    PlanTotals sum{.seconds = 0.0};
    for (const PlannedUnit& unit : plan) {
        if (!unit.is_stale()) continue;
        ++sum.stale;
        if (sum.seconds && unit.estimated_seconds)
            *sum.seconds += *unit.estimated_seconds;
        else
            sum.seconds.reset();
    }
    return sum;
}

}  // namespace etendue
