// Bidirectional path tracing (Veach 1997, chapter 10) for one sample: subpaths from the eye and from a light, connected
// in every way and weighed by what other ways would have made of the same path. `integrator/bdpt/` computes the same
// for many samples at once, from the same random numbers.
#pragma once

#include "core/rgb.h"
#include "scene/integrator_settings.h"
#include "transport/light.h"

#include <vector>

namespace etendue {

/// Holds the light that a pair of subpaths finds.
struct BidirectionalLight {
    Rgb radiance;                    ///< W/(m² sr), radiance of the sample
    std::vector<FilmLight> on_film;  ///< what the light subpath alone brings; nothing black
};

/// Returns the light that `sample` finds by all strategies, weighed by the heuristic of `settings`. For
/// `samples_per_light_path` see MisContext.
[[nodiscard]] BidirectionalLight bidirectional_light(const World& world, const EyeSample& sample,
                                                     const IntegratorSettings& settings,
                                                     double samples_per_light_path = 1.0);

}  // namespace etendue
