// Light of lamps whose radiance depends on the place.
#pragma once

#include "core/rgb.h"
#include "core/vec.h"
#include "world/world_data.h"

#include <cstdint>

namespace etendue {

class Materials;

/// Returns whether the light of this index is a mesh or a shape whose radiance depends on the place.
[[nodiscard]] bool has_uneven_emission(const WorldData& data, std::uint32_t light);
/// Returns the radiance, W/(m² sr), that a point of a mesh or a shape that is a light emits towards `direction` at
/// `time`, in [0, 1]; black where another emitter in the same place hides the point.
[[nodiscard]] Rgb mesh_emission(const WorldData& data, const Materials& materials, std::uint32_t light,
                                std::uint32_t triangle, Vec2f barycentric, const Vec3f& direction, float time);

}  // namespace etendue
