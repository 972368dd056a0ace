// What light is chosen for: a point, and what is known of the surface there.
#pragma once

#include "core/vec.h"

namespace etendue {

/// Says roughly how a surface reflects: a share as a diffuse surface does, and the rest around the mirror's direction.
/// Its eleven floats, from the position on, lie in a row from which lanes are loaded (core/wide_rows.h).
struct alignas(64) LightReceiver {
    Vec3f position{0.0f};  ///< metres
    /// Unit, on the side that light is reflected on; zero where light from everywhere may count: in media, and on
    /// surfaces that let light through.
    Vec3f normal{0.0f};
    Vec3f wo{0.0f};       ///< unit, towards where light is reflected to; of no meaning if `glossy` is 0
    float glossy = 0.0f;  ///< the share around the mirror's direction, [0, 1]
    float alpha = 1.0f;   ///< roughness² of that

    LightReceiver() = default;
    /// Nothing but a point.
    LightReceiver(const Vec3f& point) : position(point) {}  // NOLINT(google-explicit-constructor): the most common
    /// Makes a receiver on a diffuse surface at `point` with the unit normal `facing`.
    LightReceiver(const Vec3f& point, const Vec3f& facing) : position(point), normal(facing) {}

    [[nodiscard]] bool has_normal() const { return normal != Vec3f(0.0f); }
};

}  // namespace etendue
