// Where lights are, which way they shine and how strongly: what is known of a group of them without looking at each.
//
// The cone of normals, the angle of emission and the measure of both are those of Conty Estevez and Kulla, "Importance
// Sampling of Many Lights with Adaptive Tree Splitting", HPG 2018, sections 4.1 and 4.3.
#pragma once

#include "core/bounds.h"
#include "core/vec.h"

#include <cstddef>

namespace etendue {

/// All normals lie within the cone around `axis` with half angle `theta_o`, and light leaves at most `theta_e` from one
/// of them. Radians; theta_o in [0, pi], theta_e in [0, pi / 2].
struct EmissionCone {
    Vec3f axis{0.0f, 0.0f, 1.0f};  ///< unit; any, if theta_o is pi
    double theta_o = 0.0;
    double theta_e = 0.0;
    bool two_sided = false;  ///< and all of it backwards, too

    /// Around both.
    [[nodiscard]] EmissionCone united(const EmissionCone& other) const;
    /// Solid angle, steradians, that it shines into, times the mean of the cosine beyond the cone of normals: power
    /// over it is the intensity along the axis. Never zero.
    [[nodiscard]] double measure() const;
};

/// A light that is not at infinity, or several.
struct LightBounds {
    Bounds box;
    EmissionCone cone;
    double power = 0.0;     ///< watts, mean of the channels
    std::size_t count = 1;  ///< how many lights

    /// Returns the bounds of both lights together.
    [[nodiscard]] LightBounds united(const LightBounds& other) const;
};

}  // namespace etendue
