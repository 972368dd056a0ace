#include "world/world_data.h"

#include "world/contacts.h"
#include "world/embree_scene.h"

namespace etendue {

WorldData::WorldData() = default;
WorldData::~WorldData() = default;
WorldData::WorldData(WorldData&&) noexcept = default;
WorldData& WorldData::operator=(WorldData&&) noexcept = default;

float WorldData::bounding_radius() const {
    const float radius = 0.5f * length(bounds.size());
    return radius > 0.0f ? radius : 1.0f;
}

}  // namespace etendue
