// The entry of an image in the report of a batch before anything is done for it.
#pragma once

#include "batch/batch_ledger.h"
#include "batch/batch_options.h"
#include "batch/batch_plan.h"
#include "report/batch_report.h"

namespace etendue {

/// Returns what is known of an image before it was looked at.
[[nodiscard]] BatchUnit unknown_unit(const BatchTask& task, const BatchOptions& options);

/// Returns what is known of an image that was planned.
[[nodiscard]] BatchUnit planned_unit(const PlannedUnit& planned, const BatchOptions& options);

/// Returns what is known of an image that is left as it is, without loading its scene.
[[nodiscard]] BatchUnit left_out_unit(const BatchTask& task, const BatchOptions& options, const LedgerHistory& history);

}  // namespace etendue
