// A rectangle as it is seen from a point: directions to it are sampled uniformly in solid angle (Ureña, Fajardo and
// King, "An Area-Preserving Parametrization for Spherical Rectangles", Computer Graphics Forum 32(4), 2013).
//
// Its inner angles at the corners are kept as complex numbers, whose product has their sum: four square roots in place
// of four inverse cosines.
#pragma once

#include "core/vec.h"

#include <complex>

namespace etendue {

class SphericalRectangle {
  public:
    /// Looks at a rectangle of these sizes, > 0, from a point for which its least corner is at (x, y, z).
    SphericalRectangle(const Vec3f& corner, const Vec2f& size);

    /// Returns the solid angle under which the rectangle is seen, steradians; 0 from a point of its plane.
    [[nodiscard]] double solid_angle() const { return solid_angle_; }
    /// Returns the place that `u`, in [0, 1)², chooses uniformly by solid angle, in parts of the sizes; not meaningful
    /// if the solid angle is 0.
    [[nodiscard]] Vec2f sample(Vec2f u) const;

  private:
    double x0_, y0_, x1_, y1_;  ///< the rectangle's edges, seen from the point
    double z_squared_;
    std::complex<double> far_angles_;  ///< at the corners with the lesser x, of any length
    double solid_angle_ = 0.0;
};

}  // namespace etendue
