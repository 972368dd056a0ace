// What rooms of agreement are made of.
#pragma once

#include "scene/scene_desc.h"

namespace etendue::test {

/// Returns glTF's model of plastic: diffuse below a glossy layer.
[[nodiscard]] MaterialDesc gltf_plastic();
/// Copper; a mirror if `roughness` is 0.
[[nodiscard]] MaterialDesc conductor(float roughness);
/// `attenuation` is what is left of white after 0.3 m.
[[nodiscard]] MaterialDesc glass(float roughness, float dispersion = 0.0f, const Rgb& attenuation = Rgb(1.0f));

/// A floor and a wall behind it.
void add_room(SceneDesc& scene);
void add_ball(SceneDesc& scene, MaterialDesc material);
/// Throws a shadow, and is out of focus for a lens.
void add_occluder(SceneDesc& scene);
/// Shines down from the ceiling that there is none of.
void add_lamp(SceneDesc& scene, bool two_sided = false);
void add_environment(SceneDesc& scene);

[[nodiscard]] LightDesc light(LightType type, float intensity, const Mat4f& to_world);
[[nodiscard]] LightDesc point_light();
[[nodiscard]] LightDesc spot_light();
[[nodiscard]] LightDesc sun_light();
/// About +X, so that -Z points down.
[[nodiscard]] Mat4f looking_down(float angle);

}  // namespace etendue::test
