// Parts for scenes whose radiance is known: grey, few surfaces, one view of nearly one point.
#pragma once

#include "core/vec.h"
#include "scene/scene_desc.h"

#include <numbers>

namespace etendue::test {

/// Of the grey surfaces of most scenes.
inline constexpr float kAlbedo = 0.6f;
inline constexpr double kRho = 0.6;
inline constexpr double kPiD = std::numbers::pi;

/// A Lambertian surface.
[[nodiscard]] MaterialDesc diffuse(float albedo);
/// A black surface that emits `radiance` from its front.
[[nodiscard]] MaterialDesc emitter(float radiance);
/// A black surface that stops a ray with probability `alpha`.
[[nodiscard]] MaterialDesc black_card(float alpha, AlphaMode mode = AlphaMode::Blend);

/// A parallelogram; its front is the side to which edge_u × edge_v points.
[[nodiscard]] PrimitiveDesc parallelogram(const Vec3f& center, const Vec3f& edge_u, const Vec3f& edge_v);
/// A square of side `size` in a plane of constant y.
[[nodiscard]] PrimitiveDesc quad_facing_up(const Vec3f& center, float size);
[[nodiscard]] PrimitiveDesc quad_facing_down(const Vec3f& center, float size);
/// A closed box between two corners, its fronts outside.
[[nodiscard]] PrimitiveDesc box(const Vec3f& low, const Vec3f& high);
/// A regular polygon of `segments` corners on a circle, facing -Y.
[[nodiscard]] PrimitiveDesc disk_facing_down(const Vec3f& center, float radius, int segments);
enum class Facing { Outwards, Inwards };
/// An icosahedron whose triangles have been quartered `subdivisions` times, corners on the sphere.
[[nodiscard]] PrimitiveDesc sphere(const Vec3f& center, float radius, int subdivisions, Facing facing);

/// Adds a mesh of the triangles of `shape`, faceted, or of the exact shape that it is, and one instance of it.
void add(SceneDesc& scene, const PrimitiveDesc& shape, const MaterialDesc& material, const Mat4f& to_world = Mat4f());

/// Adds a light at `position` that points along the unit vector `direction`. Returns it for the settings of spots.
LightDesc& add_light(SceneDesc& scene, LightType type, float intensity, const Vec3f& position,
                     const Vec3f& direction = {0.0f, -1.0f, 0.0f});
/// Sets a white environment of radiance 1.
void set_environment(SceneDesc& scene);

/// Makes an orthographic camera at `eye` that looks along the unit vector `direction` and sees `half_width` metres to
/// each side.
void look(SceneDesc& scene, const Vec3f& eye, const Vec3f& direction, float half_width = 1e-4f);

}  // namespace etendue::test
