// The compiled scene in the statistics of a render.
#pragma once

#include "output/statistics.h"
#include "world/world.h"

namespace etendue {

/// Fills in what is known once the scene is compiled.
void fill_world_statistics(const World& world, RenderStatistics& statistics);

/// Fills in what the textures took, once all is rendered and their cache has held what it will. Look-ups that failed
/// are an error to tell, not one to lose the image for.
void fill_texture_statistics(const World& world, RenderStatistics& statistics);

}  // namespace etendue
