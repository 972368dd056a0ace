// Bidirectional path tracing (Veach 1997, chapter 10) for one sample: subpaths from the eye and from a light, connected
// in every way and weighed by what other ways would have made of the same path; and, where asked for, merged
// (merging.h). `integrator/bdpt/` computes the same for many samples at once, from the same random numbers.
#pragma once

#include "core/rgb.h"
#include "scene/integrator_settings.h"
#include "transport/light.h"
#include "transport/photon_map.h"
#include "transport/subpath.h"

#include <optional>
#include <vector>

namespace etendue {

/// Holds what samples of bidirectional path tracing depend on besides the settings.
struct BidirectionalSetup {
    double samples_per_light_path = 1.0;  ///< see MisContext
    Merging merging{};                    ///< where subpaths merge
    const PhotonMap* photons = nullptr;   ///< photons of the light subpaths of all samples; null: none merge
    std::optional<SampleKey> shared{};    ///< see SubpathSample
};

/// Holds the light that a pair of subpaths finds.
struct BidirectionalLight {
    Rgb radiance;                    ///< W/(m² sr), radiance of the sample
    std::vector<FilmLight> on_film;  ///< light that the light subpath alone brings; nothing black
};

/// Returns the light that `sample` finds by all strategies, weighed by the heuristic of `settings`.
[[nodiscard]] BidirectionalLight bidirectional_light(const World& world, const EyeSample& sample,
                                                     const IntegratorSettings& settings,
                                                     const BidirectionalSetup& setup = {});

}  // namespace etendue
