// All paths that the strategies of bidirectional path tracing (transport/strategies.h) make of samples.
#pragma once

#include "integrator/bdpt/complete_path.h"
#include "scene/integrator_settings.h"
#include "wave/tile_job.h"

#include <functional>

namespace etendue::test {

/// Hears of a path, and of the weight that its strategy has by the recursion.
using HearPath = std::function<void(const CompletePath& path, double weight)>;

/// Calls `hear` with each path that brings light to a sample of `job`, but for lamps that the eye sees directly.
void for_each_path(const World& world, const TileJob& job, const IntegratorSettings& settings, const HearPath& hear);

}  // namespace etendue::test
