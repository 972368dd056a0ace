#include "batch/batch_unit_report.h"

#include "batch/batch_attempt.h"
#include "batch/batch_statistics.h"
#include "session/up_to_date.h"

#include <filesystem>

namespace etendue {

BatchUnit unknown_unit(const BatchTask& task, const BatchOptions& options) {
    const ImageJob& job = task.job;
    BatchUnit unit{.id = task.id,
                   .name = job.name,
                   .scene = job.scene.string(),
                   .frame = job.frame,
                   .variant = job.variant.value_or(""),
                   .camera = job.camera.value_or(""),
                   .image = job.output.lexically_relative(options.output).string()};
    const std::filesystem::path shown = options.denoise ? denoised_path(unit.image) : std::filesystem::path(unit.image);
    if (options.overrides.png) unit.preview = std::filesystem::path(shown).replace_extension(".png").string();
    return unit;
}

BatchUnit planned_unit(const PlannedUnit& planned, const BatchOptions& options) {
    BatchUnit unit = unknown_unit(planned.task, options);
    unit.outcome = planned.is_stale() ? UnitOutcome::NotStarted : UnitOutcome::UpToDate;
    unit.reason = planned.reason;
    unit.estimated_seconds = planned.estimated_seconds;
    if (unit.camera.empty()) unit.camera = planned.outline.camera;
    if (!planned.is_stale()) {
        read_statistics(OutputPaths::beside(planned.task.job.output).json, unit);
        if (unit.seconds) unit.seconds->denoise = planned.denoise_seconds.value_or(0.0);
        return unit;
    }
    unit.error = planned.error;
    unit.width = planned.outline.width;
    unit.height = planned.outline.height;
    unit.spp_requested = planned.outline.spp;
    unit.integrator = planned.outline.integrator;
    return unit;
}

BatchUnit left_out_unit(const BatchTask& task, const BatchOptions& options, const LedgerHistory& history) {
    BatchUnit unit = unknown_unit(task, options);
    unit.is_chosen = false;
    unit.outcome = UnitOutcome::NotChosen;
    const OutputPaths paths = OutputPaths::beside(task.job.output, options.overrides.png);
    const LedgerHistory::Entry* const last = history.find(task.id);
    // An image that failed in the batch may have been rendered by another command since.
    if (!why_unfinished(paths) && !why_outdated(paths, task.job.scene)) {
        unit.outcome = UnitOutcome::UpToDate;
        read_statistics(paths.json, unit);
        const bool is_denoised = options.denoise && last != nullptr;
        if (unit.seconds && is_denoised) unit.seconds->denoise = last->denoise_seconds.value_or(0.0);
    } else if (last != nullptr && last->kind == LedgerEventKind::UnitFailed) {
        unit.outcome = UnitOutcome::Failed;
        unit.error = last->error;
    }
    return unit;
}

}  // namespace etendue
