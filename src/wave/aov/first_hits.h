// What camera rays have hit, as layers of the film.
#pragma once

#include "wave/camera_wave.h"

#include <span>

namespace etendue {

/// Puts down in `tile.wave_hits()` what `job.aovs` asks for of the first surfaces: `rays` are those of `samples`,
/// `hits` what they met. `accumulate` adds it to the layers, of the samples that it keeps.
void find_first_hits(const World& world, const TileJob& job, std::span<const CameraSample> samples,
                     std::span<const Ray> rays, std::span<const Hit> hits, TileBuffer& tile);

}  // namespace etendue
