#include "accelerator/triangle_test.h"

#include <cmath>

namespace etendue {

TriangleTest::TriangleTest(const Ray& ray) : t_max_(ray.t_max) {
    const Vec3f& d = ray.direction;
    int fastest = std::abs(d.x) > std::abs(d.y) ? 0 : 1;
    if (std::abs(d.z) > std::abs(d[fastest])) fastest = 2;
    axes_ = {(fastest + 1) % 3, (fastest + 2) % 3, fastest};
    for (int i = 0; i < 3; ++i) origin_[i] = static_cast<double>(ray.origin[axes_[static_cast<std::size_t>(i)]]);
    const auto speed = static_cast<double>(d[fastest]);
    shear_ = {static_cast<double>(d[axes_[0]]) / speed, static_cast<double>(d[axes_[1]]) / speed, 1.0 / speed};
}

bool TriangleTest::meets(const Triangle& triangle, TriangleHit& hit) const {
    const auto sheared = [&](const Vec3f& corner) {
        const Vec3d p = Vec3d(corner[axes_[0]], corner[axes_[1]], corner[axes_[2]]) - origin_;
        return Vec3d(p.x - shear_.x * p.z, p.y - shear_.y * p.z, p.z);
    };
    const Vec3d a = sheared(triangle.a);
    const Vec3d b = sheared(triangle.b);
    const Vec3d c = sheared(triangle.c);
    // Twice the signed areas of the triangles of zero and an edge: the weights of the opposite corners.
    const double weight_a = c.x * b.y - c.y * b.x;
    const double weight_b = a.x * c.y - a.y * c.x;
    const double weight_c = b.x * a.y - b.y * a.x;
    const bool is_inside = (weight_a >= 0.0 && weight_b >= 0.0 && weight_c >= 0.0) ||
                           (weight_a <= 0.0 && weight_b <= 0.0 && weight_c <= 0.0);
    const double sum = weight_a + weight_b + weight_c;
    if (!is_inside || sum == 0.0) return false;
    const auto t = static_cast<float>((weight_a * a.z + weight_b * b.z + weight_c * c.z) / sum * shear_.z);
    if (!(t > 0.0f && t <= t_max_)) return false;
    hit.t = t;
    hit.u = static_cast<float>(weight_b / sum);
    hit.v = static_cast<float>(weight_c / sum);
    return true;
}

}  // namespace etendue
