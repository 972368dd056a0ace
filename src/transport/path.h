// Path tracing: eye paths that meet light by next-event estimation and by chance, combined by multiple importance
// sampling (Kajiya 1986; Veach 1997, chapter 9). Here for one sample, to be read; `integrator/path/` computes the same
// for many samples at once, from the same random numbers.
#pragma once

#include "core/rgb.h"
#include "transport/path_lengths.h"
#include "transport/walk.h"

#include <cstdint>

namespace etendue {

struct PathOptions {
    PathLengths lengths;
    bool sample_lights = true;  ///< false: lights are found by chance only, which is the naive path tracer
    /// Next-event splitting: lights sampled at each vertex that the eye sees directly or in mirrors and smooth glass,
    /// >= 1.
    std::uint32_t light_samples = 1;
};

/// Returns the radiance that `sample` finds, W/(m² sr).
[[nodiscard]] Rgb path_radiance(const World& world, const EyeSample& sample, const PathOptions& options);

}  // namespace etendue
