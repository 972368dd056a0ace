// How a path's cone goes on after a bounce.
#pragma once

#include "bsdf/bsdf_sample.h"
#include "core/ray_cone.h"
#include "integrator/integrator.h"

namespace etendue {

/// The cone of one pixel around the camera ray `ray`.
[[nodiscard]] RayCone camera_cone(const World& world, const TileJob& job, const Ray& ray);

/// The cone that leaves `point` along `sample`, for one that arrives along `direction` with its width there. Mirrors
/// and smooth refraction bend it by the curvature of the surface; lobes widen it as far as they are wide themselves.
[[nodiscard]] RayCone scattered_cone(const World& world, const SurfacePoint& point, const Vec3f& direction,
                                     const RayCone& arriving, const BsdfSample& sample);

}  // namespace etendue
