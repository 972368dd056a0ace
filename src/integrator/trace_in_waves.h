// The samples of a tile, as many at a time as a wave holds.
#pragma once

#include "integrator/integrator.h"
#include "wave/camera_wave.h"

#include <algorithm>
#include <cstddef>

namespace etendue {

/// Traces all samples of the job, as many at a time as a `Wave`, which `scratch` is, holds.
template <typename Wave, typename Options>
void trace_in_waves(const World& world, const TileJob& job, const Options& options, IntegratorScratch& scratch,
                    TileBuffer& tile, RenderCounters& counters) {
    auto& wave = static_cast<Wave&>(scratch);
    const std::size_t total = camera_sample_count(job);
    for (std::size_t first = 0; first < total; first += Wave::kCapacity)
        wave.trace(world, job, options, first, std::min(Wave::kCapacity, total - first), tile, counters);
}

}  // namespace etendue
