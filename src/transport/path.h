// Path tracing: eye paths that meet light by next-event estimation and by chance, combined by multiple importance
// sampling (Kajiya 1986; Veach 1997, chapter 9). Here for one sample, to be read; `integrator/path/` computes the same
// for many samples at once, from the same random numbers.
#pragma once

#include "core/rgb.h"
#include "scene/integrator_settings.h"
#include "transport/walk.h"

namespace etendue {

/// Returns the radiance that `sample` finds, W/(m² sr).
[[nodiscard]] Rgb path_radiance(const World& world, const EyeSample& sample, const IntegratorSettings& settings);

}  // namespace etendue
