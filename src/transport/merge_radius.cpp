#include "transport/merge_radius.h"

#include "transport/scattered_cone.h"
#include "world/motion.h"
#include "world/world.h"

namespace etendue {

Merging make_merging(const World& world, int width, int height, double light_paths, std::uint32_t sample,
                     const MergeSettings& options) {
    if (!world.traits().has_lights || (options.at == MergeAt::SeenByDeltas && !world.traits().has_specular_surfaces))
        return {};
    // In radii of the scene. The least only keeps radii above zero: what bounds them is how precisely places are known.
    constexpr float kLeast = 1e-12f;
    constexpr float kMost = 0.02f;
    constexpr Vec2f kMiddle{0.5f, 0.5f};
    const Ray ray = world.camera().generate_ray(kMiddle, kMiddle, kMidShutter);
    MergeRadius radius{.eye = ray.origin, .pixel = camera_cone(world, width, height, ray)};
    const double shrunk = std::pow(static_cast<double>(sample) + 1.0, 0.5 * (options.alpha - 1.0));
    radius.scale =
        std::min(static_cast<float>(options.radius * shrunk), MergeRadius::kMostSlope / std::abs(radius.pixel.spread));
    radius.least = kLeast * world.geometry().bounding_radius();
    radius.most = kMost * world.geometry().bounding_radius();
    return {.at = options.at, .radius = radius, .light_paths = light_paths};
}

}  // namespace etendue
