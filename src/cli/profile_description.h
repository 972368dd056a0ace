// The description of the scene, the machine and the runs in the report of `etendue profile`.
#pragma once

#include "profile/profile_runs.h"
#include "report/profile_report.h"
#include "world/world.h"

namespace etendue {

/// Fills in what is known before anything is measured, but for the command and the path of the scene.
void describe(ProfileReport& report, const RenderSettings& settings, const World& world);

void describe_memory(ProfileReport& report, const World& world, const ProfileRuns& runs);

/// Adds a note to `report` for each run that cannot be relied on: because its time stamps took 1% of its time or more,
/// because the machine had other work, or because its repetitions disagree.
void note_doubtful_runs(ProfileReport& report);

}  // namespace etendue
