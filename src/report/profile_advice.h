// What the figures of a profile say about making its renders faster.
#pragma once

#include "report/profile_report.h"

#include <string>
#include <vector>

namespace etendue {

/// Returns sentences on what takes much of the time of `run`, the most first; none where nothing stands out.
[[nodiscard]] std::vector<std::string> costs(const ProfileRun& run);

/// Returns sentences on what would make `run` less work, the most first; none where nothing would.
[[nodiscard]] std::vector<std::string> advice(const ProfileRun& run);

/// Returns a sentence on the runs of which others took more than a fifth of the threads' time while stages were timed;
/// empty if there are none.
[[nodiscard]] std::string busy_machine(const std::vector<ProfileRun>& runs);

/// A sentence if the repetitions of `run` differ by more than a tenth in their CPU time; else empty.
[[nodiscard]] std::string disagreement_of_repetitions(const ProfileRun& run);

}  // namespace etendue
