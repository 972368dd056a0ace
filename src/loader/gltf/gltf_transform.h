// glTF's ways to write a transform, in Imath's row-vector convention and double precision.
#pragma once

#include "core/vec.h"

#include <array>
#include <optional>
#include <vector>

namespace etendue {

using Mat4d = Imath::M44d;

/// Rotation matrix of the quaternion x, y, z, w, which is normalised first. Nothing if it is zero.
[[nodiscard]] std::optional<Mat4d> rotation_matrix(const std::array<double, 4>& quaternion);

/// A glTF matrix, whose 16 numbers in memory are those of a row-vector matrix. Nothing if it is not affine.
[[nodiscard]] std::optional<Mat4d> affine_matrix(const std::vector<double>& m);

[[nodiscard]] Mat4f to_float(const Mat4d& m);

}  // namespace etendue
