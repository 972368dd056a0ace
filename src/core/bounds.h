// An axis-aligned box, grown point by point.
#pragma once

#include "core/vec.h"

#include <algorithm>
#include <limits>

namespace etendue {

struct Bounds {
    Vec3f min{std::numeric_limits<float>::infinity()};
    Vec3f max{-std::numeric_limits<float>::infinity()};

    [[nodiscard]] bool empty() const { return min.x > max.x; }
    [[nodiscard]] Vec3f center() const { return empty() ? Vec3f(0.0f) : (min + max) * 0.5f; }
    [[nodiscard]] Vec3f size() const { return empty() ? Vec3f(0.0f) : max - min; }

    void extend(const Vec3f& p) {
        min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
        max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
    }
    void extend(const Bounds& b) {
        if (b.empty()) return;
        extend(b.min);
        extend(b.max);
    }
};

/// Returns the bounds of the box `bounds` after the transform `m`; empty bounds stay empty.
[[nodiscard]] inline Bounds placed(const Bounds& bounds, const Mat4f& m) {
    Bounds result;
    if (bounds.empty()) return result;
    for (int corner = 0; corner < 8; ++corner)
        result.extend(transform_point(
            m, {(corner & 1) != 0 ? bounds.max.x : bounds.min.x, (corner & 2) != 0 ? bounds.max.y : bounds.min.y,
                (corner & 4) != 0 ? bounds.max.z : bounds.min.z}));
    return result;
}

/// True if `a` and `b` have a point in common.
[[nodiscard]] inline bool overlap(const Bounds& a, const Bounds& b) {
    return a.min.x <= b.max.x && a.max.x >= b.min.x && a.min.y <= b.max.y && a.max.y >= b.min.y && a.min.z <= b.max.z &&
           a.max.z >= b.min.z;
}

}  // namespace etendue
