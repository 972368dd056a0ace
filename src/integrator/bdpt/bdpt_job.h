// What a wave of bidirectional path tracing is traced for.
#pragma once

#include "integrator/bdpt/diffuse_connections.h"
#include "scene/integrator_settings.h"
#include "transport/strategy_sums.h"
#include "wave/subpath/subpath_wave.h"

namespace etendue {

/// True if a strategy (0, t), by which eye subpaths meet lamps, has a part in the image.
[[nodiscard]] inline bool meets_lamps(const IntegratorSettings& settings) {
    return !settings.strategy || (settings.strategy->s == 0 && *settings.strategy != kMerges);
}

/// Adds to what subpaths are traced for how they are connected.
struct BdptJob : SubpathJob {
    const IntegratorSettings& settings;

    /// True if the vertex may be connected to those of other samples: each sample has a time and a wavelength of
    /// its own.
    [[nodiscard]] bool is_shared(const ConnectibleVertex& vertex) const {
        return settings.cached_connections > 0 && !world().traits().has_motion && !vertex.is_dispersed;
    }
    [[nodiscard]] bool wants(const Strategy& strategy) const {
        return !settings.strategy || *settings.strategy == strategy;
    }
    [[nodiscard]] WeightRule rule() const { return {mis.raised, settings.weighted}; }
    [[nodiscard]] float weight(const StrategySums& sums) const { return rule().weight(sums); }
};

}  // namespace etendue
