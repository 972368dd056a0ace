#include "integrator/scattered_cone.h"

namespace etendue {

RayCone camera_cone(const World& world, const TileJob& job, const Ray& ray) {
    const float pixel_area = 1.0f / (static_cast<float>(job.full_width) * static_cast<float>(job.full_height));
    return pixel_cone(world.camera(), ray.direction, pixel_area);
}

}  // namespace etendue
