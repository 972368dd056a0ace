#include "scene/transform.h"

#include <cmath>

namespace etendue {

namespace {

Vec3d axis(const Mat4f& m, int row) {
    return {static_cast<double>(m[row][0]), static_cast<double>(m[row][1]), static_cast<double>(m[row][2])};
}

}  // namespace

bool is_finite(const Mat4f& m) {
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            if (!std::isfinite(m[row][column])) return false;
        }
    }
    return true;
}

bool is_invertible(const Mat4f& m) {
    if (!is_finite(m)) return false;
    if (m[0][3] != 0.0f || m[1][3] != 0.0f || m[2][3] != 0.0f || m[3][3] != 1.0f) return false;

    const Vec3d x = axis(m, 0);
    const Vec3d y = axis(m, 1);
    const Vec3d z = axis(m, 2);
    const double volume = std::abs(x.cross(y).dot(z));
    const double box = x.length() * y.length() * z.length();

    // Below this ratio of volumes the normals of the transformed surface are rounding noise.
    constexpr double kLeastShear = 1e-7;
    // The determinant and its inverse must be normal floats.
    constexpr double kLeastVolume = 1e-30;
    return volume >= kLeastVolume && volume <= 1.0 / kLeastVolume && volume >= kLeastShear * box;
}

std::optional<Mat4f> rigid_part(const Mat4f& m) {
    if (!is_finite(m)) return std::nullopt;
    const Vec3d z = axis(m, 2).normalized();
    const Vec3d x = axis(m, 1).normalized().cross(z);
    if (!(z.length() > 0.5) || !(x.length() > 1e-6)) return std::nullopt;
    const Vec3d right = x.normalized();
    const Vec3d up = z.cross(right);

    const auto f = [](double v) { return static_cast<float>(v); };
    return Mat4f(f(right.x), f(right.y), f(right.z), 0.0f, f(up.x), f(up.y), f(up.z), 0.0f, f(z.x), f(z.y), f(z.z),
                 0.0f, m[3][0], m[3][1], m[3][2], 1.0f);
}

}  // namespace etendue
