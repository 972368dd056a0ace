// What the statistics beside an image say, for the report of a batch.
#pragma once

#include "report/batch_report.h"

#include <filesystem>

namespace etendue {

/// Fills size, samples, times, warnings and the like of `unit` from the file that `etendue render` writes beside an
/// image. What is not in it, or if it is no such file, stays unknown.
void read_statistics(const std::filesystem::path& file, BatchUnit& unit);

}  // namespace etendue
