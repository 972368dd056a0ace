// An orthonormal frame around a normal; local coordinates have z along the normal.
#pragma once

#include "core/vec.h"

#include <cmath>

namespace etendue {

struct Frame {
    Vec3f tangent{1.0f, 0.0f, 0.0f};
    Vec3f bitangent{0.0f, 1.0f, 0.0f};
    Vec3f normal{0.0f, 0.0f, 1.0f};

    [[nodiscard]] Vec3f to_local(const Vec3f& v) const { return {dot(v, tangent), dot(v, bitangent), dot(v, normal)}; }
    [[nodiscard]] Vec3f to_world(const Vec3f& v) const { return tangent * v.x + bitangent * v.y + normal * v.z; }

    /// Any right-handed frame around the unit normal `n` (Duff et al., "Building an Orthonormal Basis, Revisited",
    /// JCGT 6(1), 2017).
    [[nodiscard]] static Frame from_normal(const Vec3f& n) {
        const float sign = std::copysign(1.0f, n.z);
        const float a = -1.0f / (sign + n.z);
        const float b = n.x * n.y * a;
        return {{1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
    }

    /// The frame around the unit normal `n` whose tangent is `t` made orthogonal to `n`; any frame if they are
    /// parallel.
    [[nodiscard]] static Frame from_normal_and_tangent(const Vec3f& n, const Vec3f& t) {
        const Vec3f in_plane = t - n * dot(n, t);
        const float squared = length_squared(in_plane);
        if (!(squared > 1e-12f)) return from_normal(n);
        const Vec3f tangent = in_plane * (1.0f / std::sqrt(squared));
        return {tangent, cross(n, tangent), n};
    }
};

}  // namespace etendue
