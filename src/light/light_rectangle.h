// Mesh lights of two triangles that make a rectangle, as most lamps of files are: near by, samples are uniform in solid
// angle, which leaves little noise; far away that is the same as uniform by area, which costs less.
#pragma once

#include "core/vec.h"
#include "light/light_triangle.h"
#include "sampling/spherical_rectangle.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace etendue {

/// Holds a place on one of the two triangles.
struct RectanglePlace {
    std::uint32_t triangle = 0;
    Vec2f barycentric{0.0f, 0.0f};  ///< coordinates of its second and third vertex
};

class LightRectangle {
  public:
    /// Returns the rectangle that `triangles` make, both with the same side as their front; none if they do not.
    /// `clearance` bounds what rounding may have moved their points by, metres.
    [[nodiscard]] static std::optional<LightRectangle> find(std::span<const LightTriangle> triangles,
                                                            float clearance = 0.0f);

    /// Returns the rectangle as it is seen from `point`, if that may be by so large a solid angle that samples by area
    /// are noisier.
    [[nodiscard]] std::optional<SphericalRectangle> seen_from(const Vec3f& point) const {
        return length_squared(point - center_) < near_squared_ ? seen_nearby(point) : std::nullopt;
    }
    /// Returns the place that is these parts of its sides away from its corner.
    [[nodiscard]] RectanglePlace place(Vec2f along_sides) const;

  private:
    /// Holds how places of a triangle follow from those of the rectangle.
    struct Half {
        Vec2f first;  ///< vertex, in lengths of the sides
        Vec2f to_second, to_third;
    };

    LightRectangle() = default;

    /// Answers `seen_from` for points in the sphere of `near_squared_`.
    [[nodiscard]] std::optional<SphericalRectangle> seen_nearby(const Vec3f& point) const;

    Vec3f corner_{0.0f}, center_{0.0f};
    Vec3f axis_x_{0.0f}, axis_y_{0.0f}, normal_{0.0f};  ///< unit
    Vec2f size_{0.0f, 0.0f};                            ///< metres along the first two
    float near_squared_ = 0.0f;   ///< m², of distances from the middle: beyond, samples are by area
    float flat_ = 0.0f;           ///< metres from the plane: points within lie in it, but for rounding
    std::array<Half, 2> halves_;  ///< the first is that of the corner
};

}  // namespace etendue
