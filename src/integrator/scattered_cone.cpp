#include "integrator/scattered_cone.h"

namespace etendue {

RayCone camera_cone(const World& world, const TileJob& job, const Ray& ray) {
    const float pixel_area = 1.0f / (static_cast<float>(job.full_width) * static_cast<float>(job.full_height));
    return pixel_cone(world.camera(), ray.direction, pixel_area);
}

RayCone scattered_cone(const World& world, const SurfacePoint& point, const Vec3f& direction, const RayCone& arriving,
                       const BsdfSample& sample) {
    const float spread = sample.is_delta ? 0.0f : lobe_spread(sample.pdf_solid_angle);
    // Beside a lobe as wide as this the curvature does not show.
    if (spread >= kMaxConeSpread) return scatter_cone(arriving, spread);
    const float front_curvature = world.mean_curvature(point);
    const float curvature = dot(direction, point.geometric_normal) < 0.0f ? front_curvature : -front_curvature;
    const RayCone bent =
        sample.is_transmission ? refract_cone(arriving, curvature, sample.eta) : reflect_cone(arriving, curvature);
    return sample.is_delta ? bent : scatter_cone(bent, spread);
}

}  // namespace etendue
