// What paths ask of the bodies that they go through.
#pragma once

#include "bsdf/dielectric_body.h"
#include "world/world.h"

#include <optional>

namespace etendue {

/// Returns the share of light, [0, 1], that gets `distance` metres through what fills the space within `interior`.
[[nodiscard]] inline Rgb transmittance(const World& world, const Interior& interior, float distance) {
    const HomogeneousMedium* medium = world.media().within(interior);
    return medium != nullptr ? medium->transmittance(distance) : Rgb(1.0f);
}

/// Returns the share of light, [0, 1], that gets past media between the ends of `ray`, `distance` metres apart, which
/// starts within `interior`; clear bodies may lie between them.
[[nodiscard]] inline Rgb transmittance(const World& world, const Interior& interior, const Ray& ray, float distance,
                                       RayEnds ends = RayEnds::InScene) {
    return world.traits().has_clear_bodies ? world.media().transmittance(interior, ray, ends)
                                           : transmittance(world, interior, distance);
}

/// Returns whether what leaves `material` along `sample` goes straight through: light samples and connections pass
/// that, so that there is no vertex.
[[nodiscard]] inline bool goes_straight_on(const Material& material, const BsdfSample& sample) {
    return material.is_clear && sample.is_delta && sample.is_transmission && !bends_light(sample.eta);
}

/// Names a ray that has hit a surface.
struct ArrivingRay {
    const Ray& ray;
    const Interior& interior;  ///< the bodies that the ray is in
    const Hit& hit;            ///< valid
    RayCone cone{};            ///< around the ray
};

/// Returns what `arriving` crosses at `point`, which it has hit; nothing if the surface bounds no body. Where several
/// surfaces touch, `point` becomes the one that bounds what fills the space.
[[nodiscard]] inline std::optional<Crossing> crossing_at(const World& world, SurfacePoint& point,
                                                         const ArrivingRay& arriving) {
    const auto& [ray, interior, hit, cone] = arriving;
    if (!world.traits().has_bodies || !world.media().is_boundary(point)) return {};
    return hit.in_contact ? world.media().contact_crossing(point, interior, hit, ray, cone)
                          : world.media().crossing(point, interior);
}

/// Returns the bodies on the side of a boundary to which `direction` leads.
[[nodiscard]] inline const Interior& beyond(const Crossing& crossing, const SurfacePoint& point,
                                            const Vec3f& direction) {
    return dot(direction, point.geometric_normal) > 0.0f ? crossing.outside : crossing.inside;
}

/// Returns the bodies in which a ray starts that leaves the point of `emission` along `direction`.
[[nodiscard]] inline Interior interior_at_light(const World& world, const Emission& emission, const Vec3f& direction) {
    return world.traits().has_bodies ? world.emitters().interior(emission, direction) : Interior();
}

}  // namespace etendue
