// Spheres, disks and cylinders as they are, without triangles: where rays meet them, and their surface. A rectangle is
// two triangles, which are as exact.
//
// A shape is the image of a unit shape under an affine transform, which makes ellipsoids of spheres as well. Rays are
// met in the space of the unit shape, in double precision, so that the distance of a ray's origin costs nothing of the
// surface. What is known of a place is a face and two coordinates on it (`ShapePlace`): whoever needs the point
// computes it from these, and it lies on the surface but for the rounding that core/position_error.h bounds.
#pragma once

#include "core/bounds.h"
#include "core/vec.h"
#include "shape/shape_kind.h"

#include <array>
#include <cstdint>
#include <optional>

namespace etendue {

/// Names a place on the surface of a shape.
struct ShapePlace {
    /// Tells the part of a cylinder: 0 its side, 1 its end towards +y, 2 its end towards -y; 0 for other shapes.
    std::uint32_t face = 0;
    Vec2f at{0.0f, 0.0f};  ///< [-1, 1]², but for a cylinder's side, where the first is in [-2, 2]
};

// Hits and samples of lamps keep a place where those of meshes keep a triangle and barycentric coordinates. The two
// sides of a face have different numbers: a ray that passes at random what is partly transparent decides for each.

/// Returns the number that stands for a place in place of a triangle's, together with `at`.
[[nodiscard]] inline std::uint32_t triangle_of_place(const ShapePlace& place, bool is_from_back = false) {
    return 2 * place.face + (is_from_back ? 1 : 0);
}
/// Returns the place for which these numbers stand.
[[nodiscard]] inline ShapePlace shape_place(std::uint32_t triangle, Vec2f barycentric) {
    return {triangle / 2, barycentric};
}

/// Holds what a surface is at a place, in the space of the shape's transform.
struct ShapePoint {
    Vec3f position{0.0f};
    Vec3f normal{0.0f};    ///< unit, on the front: outside of what encloses something
    Vec2f uv{0.0f, 0.0f};  ///< texture coordinates as glTF has them, v downwards
    Vec3f along_u{0.0f};   ///< derivative of the position by u
    Vec3f along_v{0.0f};   ///< derivative of the position by v
};

/// Holds a place where a line meets a shape.
struct ShapeCrossing {
    double t = 0.0;  ///< in lengths of the line's direction
    ShapePlace place;
    Vec3f normal{0.0f};         ///< normal of the front, of any length
    bool is_from_back = false;  ///< the line meets the back
};

/// Holds the crossings of a line in their order.
struct ShapeCrossings {
    std::array<ShapeCrossing, 2> all;
    std::size_t count = 0;
};

class ExactShape {
  public:
    /// Makes the image of a unit shape, any but a rectangle, under `from_unit`, which must be invertible.
    ExactShape(ShapeKind kind, const Mat4f& from_unit);

    [[nodiscard]] ShapeKind kind() const { return kind_; }
    /// Returns the shape that `transform` makes of this one.
    [[nodiscard]] ExactShape placed(const Mat4f& transform) const { return {kind_, from_unit_ * transform}; }
    /// Returns a box around the shape, as small as one can be but for rounding.
    [[nodiscard]] Bounds bounds() const;
    /// Returns the volume that the shape encloses; 0 if it is flat.
    [[nodiscard]] double volume() const;
    /// Returns the area of a face, which of a cylinder is meaningful only if it `is_round`.
    [[nodiscard]] double area(std::uint32_t face) const;
    [[nodiscard]] std::uint32_t face_count() const { return kind_ == ShapeKind::Cylinder ? 3 : 1; }
    /// Returns whether it is no ellipsoid and no slanted or elliptic cylinder, but for rounding.
    [[nodiscard]] bool is_round() const;
    /// Returns how many times as large as on the unit shape a small piece of the surface is, where the unit shape has
    /// this unit normal.
    [[nodiscard]] double stretch(const Vec3d& unit_normal) const;
    /// Returns how many times as large as here a small solid angle around the unit vector `direction` is in the space
    /// of the unit shape.
    [[nodiscard]] double direction_stretch(const Vec3d& direction) const;

    /// Finds where the line from `origin` along `direction` meets the surface, before and behind the origin.
    [[nodiscard]] ShapeCrossings crossings(const Vec3f& origin, const Vec3f& direction) const;
    /// Returns all that is known of the surface at `place`.
    [[nodiscard]] ShapePoint point(const ShapePlace& place) const;
    /// Returns the texture coordinates at `place`.
    [[nodiscard]] Vec2f uv(const ShapePlace& place) const;
    /// Returns the mean curvature at `place` of the shape as `to_world` places it, 1/m, positive where the front is
    /// convex.
    [[nodiscard]] float mean_curvature(const ShapePlace& place, const Mat4f& to_world) const;

    /// Returns a point of the shape's space in that of the unit shape.
    [[nodiscard]] Vec3d to_unit(const Vec3f& point) const;
    /// Returns the place in a direction from the centre of a unit sphere.
    [[nodiscard]] static ShapePlace sphere_place(const Vec3d& direction);
    /// Returns the place on a face that `u`, in [0, 1)², chooses uniformly by the area of the unit shape.
    [[nodiscard]] ShapePlace sample(std::uint32_t face, Vec2f u) const;

  private:
    ShapeKind kind_;
    Mat4f from_unit_;
    Imath::M44d to_unit_;
};

}  // namespace etendue
