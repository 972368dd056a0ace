#include "world/light_emitter.h"

#include "core/overloaded.h"
#include "world/light_pose.h"
#include "world/material.h"
#include "world/materials.h"
#include "world/media.h"
#include "world/mesh_emission.h"

#include <algorithm>
#include <optional>
#include <variant>
#include <vector>

namespace etendue {

namespace {

/// Returns a sphere around `geometry` as `instance` places it, at the middle of the shutter.
AimSphere sphere_around(const Geometry& geometry, const Instance& instance) {
    Bounds bounds;
    for (const Vec3f& position : geometry.positions) bounds.extend(position);
    float radius = 0.0f;
    for (const Vec3f& position : geometry.positions) radius = std::max(radius, length(position - bounds.center()));
    const bool is_ball = geometry.shape && geometry.shape->kind() == ShapeKind::Sphere && geometry.shape->is_round();
    if (is_ball) radius = 0.5f * bounds.size().x;
    const Mat4f& m = instance.to_world;
    const auto scale = [&](const Vec3f& axis) { return length(transform_vector(m, axis)); };
    return {transform_point(m, bounds.center()),
            radius * std::max({scale({1.0f, 0.0f, 0.0f}), scale({0.0f, 1.0f, 0.0f}), scale({0.0f, 0.0f, 1.0f})})};
}

/// Returns spheres around all that mirrors or refracts without roughness.
std::vector<AimSphere> specular_spheres(const WorldData& data) {
    std::vector<AimSphere> spheres;
    for (const Instance& instance : data.instances)
        for (std::uint32_t g = 0; g < instance.geometry_count; ++g) {
            const Geometry& geometry = data.geometries[instance.first_geometry + g];
            if (data.materials[geometry.material].is_specular) spheres.push_back(sphere_around(geometry, instance));
        }
    return spheres;
}

/// Aims `sample` if its numbers say so; otherwise has the light make it anew of what they leave. Then its densities are
/// those of both ways.
void aim_emission(const LightAim& aim, const Light& light, const SceneSphere& scene, EmissionNumbers& u,
                  EmissionSample& sample) {
    const auto cone = light_cone(light, sample.triangle);
    if (!cone) {
        if (is_black(sample.radiance)) return;
        const float own = sample.pdf_position_area;
        const auto place = aim.aim_from_afar(sample.direction, own, u.position);
        if (place)
            sample.position = *place - sample.direction * dot(*place - sample.position, sample.direction);
        else
            sample = sample_emission(light, u, scene);
        sample.pdf_position_area = aim.pdf_area(sample.position, sample.direction, own, place.has_value());
        return;
    }
    const auto direction = aim.aim(sample.position, *cone, u.direction);
    if (direction)
        turn_emission(light, sample, *direction);
    else
        sample = sample_emission(light, u, scene);
    sample.pdf_direction_solid_angle = aim.pdf_solid_angle(sample.position, *cone, sample.direction,
                                                           sample.pdf_direction_solid_angle, direction.has_value());
}

}  // namespace

LightEmitter::LightEmitter(const WorldData& data, const Materials& materials, const Media& media)
    : data_(data),
      materials_(materials),
      media_(media),
      choice_(choice_by_power(data.lights, data.bounding_radius())),
      aim_(specular_spheres(data)) {}

Emission LightEmitter::sample(Vec2f u_light, EmissionNumbers u, float time, bool aims) const {
    const AliasTable::Choice choice = choice_.sample(u_light);
    Emission emission;
    emission.light = choice.index;
    emission.probability = choice.probability;
    EmissionSample& sample = emission.sample;
    const Light& light = data_.lights[choice.index];
    sample = etendue::sample_emission(light, u, data_.bounding_sphere());
    if (aims && !aim_.empty()) aim_emission(aim_, light, data_.bounding_sphere(), u, sample);
    emission.ray.time = time;
    if (is_black(sample.radiance)) return emission;
    if (const auto pose = pose_of_light(data_, choice.index, time)) pose->to_world(sample);
    if (has_uneven_emission(data_, choice.index))
        sample.radiance =
            mesh_emission(data_, materials_, choice.index, sample.triangle, sample.barycentric, sample.direction, time);
    emission.weight = sample.weight() / choice.probability;
    emission.ray.origin = origin(emission, sample.direction);
    emission.ray.direction = sample.direction;
    return emission;
}

SurfaceEmission LightEmitter::surface_emission(const Emission& emission, const Vec3f& direction) const {
    const Light& light = data_.lights[emission.light];
    if (is_delta_light(light) || is_at_infinity(light)) return {};
    const Geometry& geometry = data_.geometries[data_.emitter_of_light[emission.light].geometry];
    if (!data_.materials[geometry.material].lights_camera()) return {};
    const EmissionSample& sample = emission.sample;
    const Vec3f normal = of_surface_light(
        light, Vec3f(0.0f),
        Overloaded{[&](const MeshLight& mesh) {
                       const LightTriangle& t = mesh.triangle(sample.triangle);
                       return triangle_normal(t.edge1, t.edge2);
                   },
                   [&](const ShapeLight& shape) {
                       return shape.shape().point(shape_place(sample.triangle, sample.barycentric)).normal;
                   }});
    const float time = emission.ray.time;
    return {mesh_emission(data_, materials_, emission.light, sample.triangle, sample.barycentric, direction, time),
            abs_dot(normal, direction_in_frame(pose_of_light(data_, emission.light, time), direction))};
}

Vec3f LightEmitter::origin(const Emission& emission, const Vec3f& direction) const {
    Vec3f start = emission.sample.origin(direction);
    for (const Vec3f& plane : data_.planes_of(emission.light)) start += dot(plane, direction) >= 0.0f ? plane : -plane;
    return start;
}

Interior LightEmitter::interior(const Emission& emission, const Vec3f& direction) const {
    const std::optional<Interior>& everywhere = media_.light_interior(emission.light);
    return everywhere ? *everywhere : media_.interior_at(origin(emission, direction), emission.ray.time);
}

float LightEmitter::pdf(const EmittedRay& ray, bool aims) const {
    const Light& light = data_.lights[ray.light];
    const auto pose = pose_of_light(data_, ray.light, ray.time);
    const Vec3f direction = direction_in_frame(pose, ray.direction);
    const float own = emission_pdf(light, direction, ray.cos_light, data_.bounding_sphere());
    if (!aims || aim_.empty()) return own;
    const Vec3f point = in_frame(pose, ray.point);
    const auto cone = light_cone(light, ray.triangle);
    return cone ? aim_.pdf_solid_angle(point, *cone, direction, own) : aim_.pdf_area(point, direction, own);
}

float LightEmitter::pdf_area(std::uint32_t light, const Vec3f& on_light, float time) const {
    return of_surface_light(data_.lights[light], 0.0f,
                            Overloaded{[&](const MeshLight& mesh) { return 1.0f / mesh.area(); },
                                       [&](const ShapeLight& shape) {
                                           return shape.pdf_area(in_frame(pose_of_light(data_, light, time), on_light));
                                       }});
}

}  // namespace etendue
