// The part of a triangle that is in a box, for structures that share out space rather than triangles.
#pragma once

#include "accelerator/accelerator.h"

#include <optional>

namespace etendue {

/// Returns the box around the part of `triangle` that is in the box from `low` to `high`, rounded outwards; nothing if
/// there is none. A part may have no area.
[[nodiscard]] std::optional<Bounds> clipped_bounds(const Triangle& triangle, const Vec3d& low, const Vec3d& high);

}  // namespace etendue
