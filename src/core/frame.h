// An orthonormal frame around a normal; local coordinates have z along the normal.
#pragma once

#include "core/vec.h"

#include <cmath>

namespace etendue {

/// A template of its lane type, see core/lane.h.
template <typename T>
struct BasicFrame {
    using Vec = Imath::Vec3<T>;

    Vec tangent{1.0f, 0.0f, 0.0f};
    Vec bitangent{0.0f, 1.0f, 0.0f};
    Vec normal{0.0f, 0.0f, 1.0f};

    [[nodiscard]] Vec to_local(const Vec& v) const { return {dot(v, tangent), dot(v, bitangent), dot(v, normal)}; }
    [[nodiscard]] Vec to_world(const Vec& v) const { return tangent * v.x + bitangent * v.y + normal * v.z; }

    /// Any right-handed frame around the unit normal `n` (Duff et al., "Building an Orthonormal Basis, Revisited",
    /// JCGT 6(1), 2017).
    [[nodiscard]] static BasicFrame from_normal(const Vec& n) {
        const T sign = copysign(T(1.0f), n.z);
        const T a = T(-1.0f) / (sign + n.z);
        const T b = n.x * n.y * a;
        return {{T(1.0f) + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
    }

    /// The frame around the unit normal `n` whose tangent is `t`, of any length, made orthogonal to `n`; any frame if
    /// they are parallel. Takes single vectors, not lanes.
    [[nodiscard]] static BasicFrame from_normal_and_tangent(const Vec& n, const Vec& t) {
        const T size = max_abs(t);
        if (!(size > T(0.0f))) return from_normal(n);
        const Vec scaled = t * (T(1.0f) / size);
        const Vec in_plane = scaled - n * dot(n, scaled);
        const T squared = length_squared(in_plane);
        if (!(squared > 1e-12f)) return from_normal(n);
        const Vec tangent = in_plane * (T(1.0f) / sqrt(squared));
        return {tangent, cross(n, tangent), n};
    }
};

using Frame = BasicFrame<float>;

}  // namespace etendue
