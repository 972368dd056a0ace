// Writes the notes that a reader of a comparison gets beside its figures.
#pragma once

#include "report/comparison_report.h"

#include <string>

namespace etendue {

/// Returns a note if the times of variants were to be equal and differ by more than a tenth; else returns nothing.
[[nodiscard]] std::string unequal_times(const ComparisonReport& report);

/// Returns a note if a reference that was not pooled has, or may have, noise of more than a tenth of the least error,
/// or one that was pooled has more noise than the least error of a region; else returns nothing.
[[nodiscard]] std::string reference_noise(const ComparisonReport& report);

/// Returns a note on the variants whose mean time differs from the time asked for by more than a tenth; if there are
/// none, returns nothing.
[[nodiscard]] std::string off_budget(const ComparisonReport& report);

/// Returns a note on the variants whose squared errors are not above the reference's noise; if there are none, returns
/// nothing.
[[nodiscard]] std::string drowned_errors(const ComparisonReport& report);

}  // namespace etendue
