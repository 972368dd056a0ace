#include "world/light_emitter.h"

#include "world/materials.h"
#include "world/media.h"
#include "world/mesh_emission.h"

#include <variant>

namespace etendue {

LightEmitter::LightEmitter(const WorldData& data, const Materials& materials, const Media& media)
    : data_(data), materials_(materials), media_(media), selector_(data.lights, data.bounding_radius()) {}

Emission LightEmitter::sample(Vec2f u_light, const EmissionNumbers& u, float time) const {
    const AliasTable::Choice choice = selector_.sample(u_light);
    Emission emission;
    emission.light = choice.index;
    emission.probability = choice.probability;
    EmissionSample& sample = emission.sample;
    sample = etendue::sample_emission(data_.lights[choice.index], u, data_.bounding_sphere());
    if (is_black(sample.radiance)) return emission;
    if (has_uneven_emission(data_, choice.index))
        sample.radiance =
            mesh_emission(data_, materials_, choice.index, sample.triangle, sample.barycentric, sample.direction);
    emission.weight = sample.weight() / choice.probability;
    emission.ray.origin = sample.origin(sample.direction);
    for (const Vec3f& plane : data_.planes_of(choice.index))
        emission.ray.origin += dot(plane, sample.direction) >= 0.0f ? plane : -plane;
    emission.ray.direction = sample.direction;
    emission.ray.time = time;
    return emission;
}

SurfaceEmission LightEmitter::surface_emission(const Emission& emission, const Vec3f& direction) const {
    const Light& light = data_.lights[emission.light];
    const MeshLight* mesh = std::get_if<MeshLight>(&light);
    const ShapeLight* shape = std::get_if<ShapeLight>(&light);
    if (mesh == nullptr && shape == nullptr) return {};
    const Geometry& geometry = data_.geometries[data_.emitter_of_light[emission.light].geometry];
    if (!data_.materials[geometry.material].visible_to_camera) return {};
    const EmissionSample& sample = emission.sample;
    Vec3f normal(0.0f);
    if (mesh != nullptr) {
        const LightTriangle& t = mesh->triangle(sample.triangle);
        normal = triangle_normal(t.edge1, t.edge2);
    } else {
        normal = shape->shape().point(shape_place(sample.triangle, sample.barycentric)).normal;
    }
    return {mesh_emission(data_, materials_, emission.light, sample.triangle, sample.barycentric, direction),
            abs_dot(normal, direction)};
}

Interior LightEmitter::interior(const Emission& emission) const {
    return data_.planes_of(emission.light).empty() ? media_.light_interior(emission.light)
                                                   : media_.interior_at(emission.ray.origin);
}

float LightEmitter::pdf_area(std::uint32_t light) const {
    const ShapeLight* shape = std::get_if<ShapeLight>(&data_.lights[light]);
    return 1.0f / (shape != nullptr ? shape->area() : std::get<MeshLight>(data_.lights[light]).area());
}

}  // namespace etendue
