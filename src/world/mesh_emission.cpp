#include "world/mesh_emission.h"

#include "world/cone_section.h"
#include "world/contacts.h"
#include "world/material_evaluation.h"
#include "world/materials.h"
#include "world/surface_point.h"

#include <cstddef>
#include <variant>

namespace etendue {

namespace {

/// Returns false if another emitter in the same place hides this one towards `direction`.
bool is_foremost_emitter(const WorldData& data, const SurfacePoint& point, Vec2f barycentric, const Vec3f& direction,
                         float time) {
    const std::size_t slot = slot_of(data, point.instance, point.geometry);
    if (data.shares_place_of_slot.empty() || data.shares_place_of_slot[slot] == 0) return true;
    const float height = 4.0f * data.contacts->reach(slot);
    const Vec3f side = dot(direction, point.geometric_normal) > 0.0f ? point.geometric_normal : -point.geometric_normal;
    Ray ray;
    ray.origin = point.position + side * height;
    ray.direction = -side;
    ray.time = time;
    const Hit hit{height, barycentric.x,  barycentric.y, point.triangle, point.geometry & 0x7fffffffu,
                  0,      point.instance, time};
    const Hit& seen = foremost(data, data.contacts->at(data, ray, hit), ray.direction).hit;
    return seen.instance == hit.instance && seen.geometry == hit.geometry && seen.triangle == hit.triangle;
}

}  // namespace

bool has_uneven_emission(const WorldData& data, std::uint32_t light) {
    return of_surface_light(data.lights[light], false, [](const auto& surface) { return !surface.is_uniform(); });
}

Rgb mesh_emission(const WorldData& data, const Materials& materials, std::uint32_t light, std::uint32_t triangle,
                  Vec2f barycentric, const Vec3f& direction, float time) {
    const Emitter& emitter = data.emitter_of_light[light];
    const SurfacePoint point =
        make_surface_point(data, emitter.instance, emitter.geometry, triangle, barycentric, time, ConeSection{});
    if (!is_foremost_emitter(data, point, barycentric, direction, time)) return {};
    return materials.emission(point, direction) * evaluate_opacity(data, emitter.geometry, triangle, barycentric);
}

}  // namespace etendue
