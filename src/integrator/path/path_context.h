// What the stages of a bounce are told.
#pragma once

#include "scene/integrator_settings.h"
#include "wave/tile_job.h"
#include "world/world.h"

namespace etendue {

/// Says for what, and how, the paths of a wave are traced, and how far they are.
struct PathContext {
    const World& world;
    const TileJob& job;
    const IntegratorSettings& settings;
    int rays;  ///< rays that each path has traced; its edges, if the World has no bodies

    /// Returns true if paths sample lights, and do not find them by chance only.
    [[nodiscard]] bool samples_lights() const { return settings.light_samples > 0; }
};

}  // namespace etendue
