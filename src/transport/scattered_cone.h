// How a path's cone goes on after a bounce.
#pragma once

#include "bsdf/bsdf_sample.h"
#include "core/ray_cone.h"
#include "world/world.h"

namespace etendue {

/// Returns the cone of one pixel around the camera ray `ray`, of an image of `width` × `height` pixels.
[[nodiscard]] inline RayCone camera_cone(const World& world, int width, int height, const Ray& ray) {
    const float pixel_area = 1.0f / (static_cast<float>(width) * static_cast<float>(height));
    return pixel_cone(world.camera().model(), ray.direction, pixel_area);
}

/// Returns the cone that leaves the surface at `hit`, of `geometric_normal`, along `sample`, for one that arrives along
/// `direction` with its width there. Mirrors and smooth refraction bend it by the curvature of the surface; lobes widen
/// it as far as they are wide themselves.
[[nodiscard]] inline RayCone scattered_cone(const World& world, const Hit& hit, const Vec3f& geometric_normal,
                                            const Vec3f& direction, const RayCone& arriving, const BsdfSample& sample) {
    const float spread = sample.is_delta ? 0.0f : lobe_spread(sample.pdf_solid_angle);
    // Beside a lobe as wide as this the curvature does not show.
    if (spread >= kMaxConeSpread) return scatter_cone(arriving, spread);
    const float front_curvature = world.geometry().mean_curvature(hit);
    const float curvature = dot(direction, geometric_normal) < 0.0f ? front_curvature : -front_curvature;
    const RayCone bent =
        sample.is_transmission ? refract_cone(arriving, curvature, sample.eta) : reflect_cone(arriving, curvature);
    return sample.is_delta ? bent : scatter_cone(bent, spread);
}

}  // namespace etendue
