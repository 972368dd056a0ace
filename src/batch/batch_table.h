// What a batch has done, as a table.
#pragma once

#include "report/batch_report.h"

#include <string>

namespace etendue {

/// A row for each unit that is made, up to date or failed; images are named with `output` before them. Further lines
/// count those that were not tried or not started, if any, and sum up.
[[nodiscard]] std::string to_table(const BatchReport& report, const std::string& output);

}  // namespace etendue
