#include "transport/scattered_cone.h"

namespace etendue {

RayCone camera_cone(const World& world, int width, int height, const Ray& ray) {
    const float pixel_area = 1.0f / (static_cast<float>(width) * static_cast<float>(height));
    return pixel_cone(world.camera().model(), ray.direction, pixel_area);
}

}  // namespace etendue
