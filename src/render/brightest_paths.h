// Which paths have brought the brightest contributions of a render.
#pragma once

#include "integrator/integrator.h"
#include "render/progressive_render.h"
#include "world/world.h"

namespace etendue {

/// Finds the paths of those of `state.counters.brightest` that have none yet: samples are functions of their numbers,
/// so that each is traced once more by itself, with its paths spelled out, and the contribution of the same value is
/// the one. Those that are not found so stay without: connections to a cache (IntegratorSettings::cached_connections)
/// and what has merged depend on other samples, and Whitted's trees have no words. `state` is of a render of `world` by
/// `integrator` with `options`.
void find_brightest_paths(const World& world, const Integrator& integrator, const SamplingOptions& options,
                          RenderState& state);

}  // namespace etendue
