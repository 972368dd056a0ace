// Where a ray meets a triangle, watertight: no ray passes between two triangles that share an edge.
#pragma once

#include "accelerator/accelerator.h"

#include <array>

namespace etendue {

/// Prepares a ray for the test of Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection" (JCGT 2(1), 2013). The
/// triangle is moved so that the ray starts at zero, and sheared so that it runs along the z axis. What is left is to
/// ask in the plane whether zero lies on the same side of all three edges. An edge has the same corners in both of its
/// triangles, and so the same number there but for its sign.
///
/// Unlike theirs, the test is made in double precision, so that it is also what Embree's hits are compared with.
///
/// The test of Möller and Trumbore ("Fast, Minimum Storage Ray/Triangle Intersection", Journal of Graphics Tools 2(1),
/// 1997) solves for the distance and two barycentric coordinates by Cramer's rule. It is shorter, but leaks at edges:
/// two triangles that share an edge round the ray's distance to it differently.
class TriangleTest {
  public:
    explicit TriangleTest(const Ray& ray);

    /// Sets where the ray meets `triangle` within (0, t_max], and returns true if it does; a triangle without an area,
    /// or seen from its edge, is not met.
    [[nodiscard]] bool meets(const Triangle& triangle, TriangleHit& hit) const;

  private:
    std::array<int, 3> axes_;  ///< the axis along which the ray runs fastest is the last
    Vec3d origin_;             ///< in the order of these axes
    Vec3d shear_;
    float t_max_;
};

}  // namespace etendue
