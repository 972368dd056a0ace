// Which triangles of a mesh face opposite ways.
#pragma once

#include "core/vec.h"

#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// Returns for each triangle the index of one that faces the other way, within some 20 degrees, and whose opposite the
/// triangle is in turn; its own if there is none left for it. Of those that face alike the larger ones find the larger
/// ones; no pair differs ten thousand times in area, and what has no area or no normal finds none. `normals` are unit
/// vectors or zero or no numbers, `areas` in any unit, both of one length. n log n steps, and 16 bytes a triangle while
/// it works.
[[nodiscard]] std::vector<std::uint32_t> pair_opposite_triangles(std::span<const Vec3f> normals,
                                                                 std::span<const double> areas);

}  // namespace etendue
