// Whitted's recursive ray tracing ("An Improved Illumination Model for Shaded Display", Communications of the ACM
// 23(6), 1980) for one sample: mirrored and refracted rays are both followed, and surfaces that scatter show direct
// light. `integrator/whitted/` computes the same for many samples at once, from the same random numbers.
#pragma once

#include "core/rgb.h"
#include "transport/path_lengths.h"
#include "transport/walk.h"

namespace etendue {

/// Returns the radiance that `sample` finds, W/(m² sr). Branches end by how little they contribute, whatever the
/// `roulette_depth` of `lengths`.
[[nodiscard]] Rgb whitted_radiance(const World& world, const EyeSample& sample, const PathLengths& lengths);

}  // namespace etendue
