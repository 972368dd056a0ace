#include "world/light_sampler.h"

#include "core/overloaded.h"
#include "light/light.h"
#include "world/contacts.h"
#include "world/materials.h"
#include "world/mesh_emission.h"

#include <vector>

namespace etendue {

namespace {

std::vector<std::optional<LightBounds>> bounds_of_lights(const WorldData& data) {
    std::vector<std::optional<LightBounds>> bounds;
    for (std::uint32_t light = 0; light < data.lights.size(); ++light) bounds.push_back(swept_bounds(data, light));
    return bounds;
}

}  // namespace

LightSampler::LightSampler(const WorldData& data, const Materials& materials)
    : data_(data), materials_(materials), tree_(data.lights, bounds_of_lights(data), data.bounding_radius()) {}

ChosenLight LightSampler::sample(const LightTree::Choice& choice, const Vec3f& point, const LightNumbers& u,
                                 float time) const {
    const auto pose = pose_of_light(data_, choice.light, time);
    ChosenLight chosen{
        sample_light_compensated(data_.lights[choice.light], in_frame(pose, point), u.triangle, u.direction),
        choice.probability, choice.light, time};
    LightSample& sample = chosen.sample;
    sample.pdf_solid_angle *= choice.probability;
    for (const Vec3f& plane : data_.planes_of(choice.light))
        sample.end += dot(plane, sample.wi) <= 0.0f ? plane : -plane;
    if (pose) pose->to_world(sample);
    if (!is_black(sample.radiance) && has_uneven_emission(data_, choice.light))
        sample.radiance =
            mesh_emission(data_, materials_, choice.light, sample.triangle, sample.barycentric, -sample.wi, time);
    return chosen;
}

void LightSampler::choose(std::span<const LightReceiver> receivers, std::span<const Vec2f> u,
                          std::span<LightTree::Choice> choices) const {
    tree_.sample(receivers, u, choices);
    for (const LightTree::Choice& choice : choices) __builtin_prefetch(&data_.lights[choice.light]);
}

std::uint32_t LightSampler::at(const SurfacePoint& point) const {
    return data_.light_of_slot[slot_of(data_, point.instance, point.geometry)];
}

float LightSampler::pdf_solid_angle(const LightReceiver& from, const SurfacePoint& point, const Vec3f& direction,
                                    float distance, float time) const {
    const std::uint32_t light = at(point);
    if (light == kNone) return 0.0f;
    const float cos_light = -dot(direction, point.geometric_normal);
    const float choice = probability(from, light);
    const auto pose = pose_of_light(data_, light, time);
    // Where no light needs it, `from` may mean nothing.
    const auto seen_from = [&](const auto& surface) {
        return in_frame(pose, surface.needs_exact_point() ? from.position : point.position - direction * distance);
    };
    return of_surface_light(
        data_.lights[light], 0.0f,
        Overloaded{[&](const MeshLight& mesh) {
                       return mesh.pdf_solid_angle(point.triangle, seen_from(mesh), distance, cos_light) * choice;
                   },
                   [&](const ShapeLight& shape) {
                       return shape.pdf_solid_angle(seen_from(shape), in_frame(pose, point.position), cos_light) *
                              choice;
                   }});
}

float LightSampler::gain(std::uint32_t light, std::uint32_t triangle, const Vec3f& on_light, const Vec3f& point,
                         float time) const {
    const auto pose = pose_of_light(data_, light, time);
    const Vec3f own_point = in_frame(pose, point);
    const Vec3f own_place = in_frame(pose, on_light);
    return of_surface_light(data_.lights[light], 1.0f,
                            Overloaded{[&](const MeshLight& mesh) { return mesh.gain(triangle, own_place, own_point); },
                                       [&](const ShapeLight& shape) { return shape.gain(own_place, own_point); }});
}

}  // namespace etendue
