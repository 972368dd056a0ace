// What `etendue compare` says on stderr when it is done.
#pragma once

#include "report/comparison_report.h"

#include <cstddef>

namespace etendue {

/// Prints the headline, whether images agree, the figures that are known, and the report's notes but for the first
/// `notes_said`.
void print_summary(const ComparisonReport& report, std::size_t notes_said);

}  // namespace etendue
