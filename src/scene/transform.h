// What the scene description asks of transforms.
#pragma once

#include "core/vec.h"

#include <optional>

namespace etendue {

/// True if all 16 numbers are finite.
[[nodiscard]] bool is_finite(const Mat4f& m);

/// True if `m` is finite, affine (its last column is 0, 0, 0, 1) and can be inverted in single precision: no axis is
/// collapsed or nearly parallel to the plane of the other two, and the volume scale lies in [1e-30, 1e30].
[[nodiscard]] bool is_invertible(const Mat4f& m);

/// The rotation and translation of `m` without its scale and shear, as cameras and lights take them from their node:
/// -Z keeps its direction, +Y stays in the plane of the two. Nothing if `m` collapses an axis that is needed.
[[nodiscard]] std::optional<Mat4f> rigid_part(const Mat4f& m);

}  // namespace etendue
