// The report of a batch, on disk.
#pragma once

#include "report/batch_report.h"

#include <filesystem>

namespace etendue {

/// Writes `out`/report.json and `out`/index.html, each whole or not at all, with thumbnails of the units' PNG files
/// below `out`; one that is missing or cannot be read leaves its place empty. Throws IoError if a file cannot be
/// written.
void write_batch_report(const BatchReport& report, const std::filesystem::path& out);

}  // namespace etendue
