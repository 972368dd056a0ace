#include "integrator/agreement_room.h"

#include "world/test_scene.h"

#include <cmath>
#include <utility>

namespace etendue::test {

MaterialDesc gltf_plastic() {
    MaterialDesc m;
    m.base_color = {0.7f, 0.3f, 0.2f};
    m.metallic = 0.0f;
    m.roughness = 0.5f;
    return m;
}

MaterialDesc conductor(float roughness) {
    MaterialDesc m;
    m.override_model = ConductorDesc{"Cu", roughness};
    return m;
}

MaterialDesc glass(float roughness, float dispersion, const Rgb& attenuation) {
    MaterialDesc m;
    DielectricDesc desc{.ior = 1.5f, .roughness = roughness};
    desc.volume.dispersion = dispersion;
    desc.volume.attenuation_color = attenuation;
    desc.volume.attenuation_distance = 0.3f;
    m.override_model = desc;
    return m;
}

void add_room(SceneDesc& scene) {
    const auto gray = add_material(scene, diffuse({0.6f, 0.5f, 0.4f}));
    add_object(scene, quad({0, -0.7f, -3}, {1.6f, 0, 0}, {0, 0, -1.6f}), gray);
    add_object(scene, quad({0, 0.5f, -4.4f}, {1.6f, 0, 0}, {0, 1.4f, 0}), gray);
}

void add_ball(SceneDesc& scene, MaterialDesc material) {
    add_object(scene, sphere({0.2f, -0.25f, -3.0f}, 0.4f, 12), add_material(scene, std::move(material)));
}

void add_occluder(SceneDesc& scene) {
    add_object(scene, quad({-0.5f, 0.1f, -2.2f}, {0.15f, 0.05f, 0}, {0, 0.2f, 0.1f}),
               add_material(scene, diffuse({0.2f, 0.4f, 0.7f})));
}

void add_lamp(SceneDesc& scene, bool two_sided) {
    MaterialDesc lamp = emissive(Rgb(6.0f));
    lamp.double_sided = two_sided;
    add_object(scene, quad({0, 1.3f, -3}, {0.5f, 0, 0}, {0, 0, 0.5f}), add_material(scene, lamp));
}

LightDesc light(LightType type, float intensity, const Mat4f& to_world) {
    LightDesc desc;
    desc.type = type;
    desc.intensity = intensity;
    desc.to_world = to_world;
    return desc;
}

Mat4f looking_down(float angle) {
    return {1, 0, 0, 0, 0, std::cos(angle), -std::sin(angle), 0, 0, std::sin(angle), std::cos(angle), 0, 0, 0, 0, 1};
}

void add_environment(SceneDesc& scene) {
    scene.environment.enabled = true;
    scene.environment.color = {0.5f, 0.6f, 0.9f};
    scene.environment.visible_to_camera = false;
}

LightDesc point_light() {
    return light(LightType::Point, 4.0f, translation({0.6f, 0.9f, -2.4f}));
}

LightDesc spot_light() {
    LightDesc spot = light(LightType::Spot, 9.0f, looking_down(1.2f) * translation({0.3f, 1.2f, -2.2f}));
    spot.inner_cone_angle = 0.3f;
    return spot;
}

LightDesc sun_light() {
    return light(LightType::Directional, 3.0f, looking_down(0.9f));
}

}  // namespace etendue::test
