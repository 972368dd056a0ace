#include "session/world_statistics.h"

#include "core/log.h"

namespace etendue {

void fill_world_statistics(const World& world, RenderStatistics& statistics) {
    const WorldStatistics from = world.statistics();
    statistics.isa = from.isa;
    statistics.bvh_bytes = from.bvh_bytes;
    statistics.bvh_build_seconds = from.bvh_build_seconds;
    statistics.triangles = from.triangles;
    statistics.instances = from.instances;
    statistics.lights = from.lights;
    statistics.missing_textures = from.missing_textures;
}

void fill_texture_statistics(const World& world, RenderStatistics& statistics) {
    const WorldStatistics from = world.statistics();
    statistics.textures = from.textures;
    statistics.texture_bytes = from.texture_bytes;
    statistics.textures_cached = from.textures_cached;
    statistics.texture_cache_budget = from.texture_cache_budget;
    statistics.failed_texture_lookups = from.failed_texture_lookups;
    if (from.failed_texture_lookups > 0)
        log_error("error: {} texture look-ups met broken pixels and read black: {}", from.failed_texture_lookups,
                  from.first_texture_failure);
}

}  // namespace etendue
