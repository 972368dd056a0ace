#include "loader/gltf/gltf_transform.h"

#include <cmath>

namespace etendue {

std::optional<Mat4d> rotation_matrix(const std::array<double, 4>& q) {
    const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(norm > 1e-12) || !std::isfinite(norm)) return std::nullopt;
    const double x = q[0] / norm;
    const double y = q[1] / norm;
    const double z = q[2] / norm;
    const double w = q[3] / norm;
    return Mat4d(1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w), 0,  //
                 2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w), 0,  //
                 2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y), 0,  //
                 0, 0, 0, 1);
}

std::optional<Mat4d> affine_matrix(const std::vector<double>& m) {
    constexpr double kTolerance = 1e-5;
    const bool affine = std::abs(m[3]) <= kTolerance && std::abs(m[7]) <= kTolerance && std::abs(m[11]) <= kTolerance &&
                        std::abs(m[15] - 1.0) <= kTolerance;
    if (!affine) return std::nullopt;
    return Mat4d(m[0], m[1], m[2], 0, m[4], m[5], m[6], 0, m[8], m[9], m[10], 0, m[12], m[13], m[14], 1);
}

Mat4f to_float(const Mat4d& m) {
    Mat4f result;
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) result[row][column] = static_cast<float>(m[row][column]);
    }
    return result;
}

}  // namespace etendue
