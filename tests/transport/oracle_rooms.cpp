#include "transport/oracle_rooms.h"

#include "integrator/agreement_room.h"
#include "world/test_scene.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <utility>
#include <variant>
#include <vector>

namespace etendue::test {

namespace {

std::vector<std::array<int, 4>> texels_of_veil() {
    std::vector<std::array<int, 4>> texels(64);
    for (int i = 0; auto& texel : texels) {
        texel = {200 - 2 * i, 90 + 2 * i, 60 + (i * 37) % 90, (i * 53) % 256};
        ++i;
    }
    return texels;
}

std::vector<std::array<int, 4>> texels_of_relief() {
    std::vector<std::array<int, 4>> texels(64);
    for (int i = 0; auto& texel : texels) {
        texel = {128 + (i * 29) % 60 - 30, 128 + (i * 41) % 60 - 30, 240, 255};
        ++i;
    }
    return texels;
}

/// A texture whose file is read while the world is compiled and not kept.
class TextureFile {
  public:
    explicit TextureFile(const char* name) : path_(temporary_file(name)) {}
    TextureFile(const TextureFile&) = delete;
    TextureFile& operator=(const TextureFile&) = delete;
    ~TextureFile() { std::filesystem::remove(path_); }

    Handle<TextureDesc> add(SceneDesc& scene, const std::vector<std::array<int, 4>>& texels) const {
        return add_texture(scene, path_, 8, texels);
    }

  private:
    std::filesystem::path path_;
};

MaterialDesc pane() {
    MaterialDesc material = gltf_plastic();
    material.base_color = {0.9f, 0.7f, 0.5f};
    material.transmission = 0.8f;
    material.roughness = 0.0f;
    return material;
}

MaterialDesc filling_of(RoomAir air) {
    MaterialDesc material;
    DielectricDesc desc{.ior = 1.00001f, .roughness = 0.0f};
    desc.volume.attenuation_distance = 2.0f;
    desc.volume.attenuation_color = {0.3f, 0.4f, 0.5f};
    desc.volume.priority = air == RoomAir::Resin ? 1 : -2;
    if (air == RoomAir::Fog) {
        desc.volume.multiscatter_color = {0.5f, 0.6f, 0.4f};
        desc.volume.scatter_anisotropy = 0.3f;
    }
    material.override_model = desc;
    return material;
}

}  // namespace

World crowded_room(RoomAir air) {
    SceneDesc scene = empty_scene();
    add_room(scene);
    add_occluder(scene);
    add_lamp(scene);
    const TextureFile color("oracle_color.png");
    const TextureFile relief("oracle_relief.png");
    const auto color_texture = color.add(scene, texels_of_veil());
    const auto relief_texture = relief.add(scene, texels_of_relief());
    // Water in a glass with dispersion.
    add_object(scene, sphere({0.4f, -0.25f, -3.0f}, 0.4f, 12), add_material(scene, glass(0.0f, 2.0f, Rgb(0.8f))));
    add_object(scene, sphere({0.4f, -0.25f, -3.0f}, 0.25f, 12),
               add_material(scene, glass(0.3f, 0.0f, {0.2f, 0.6f, 0.9f})));
    if (air != RoomAir::Vacuum)
        add_object(scene, sphere({0.0f, 0.0f, -2.0f}, 6.0f, 16), add_material(scene, filling_of(air)));
    add_object(scene, quad({-0.4f, 0.1f, -2.0f}, {0.3f, 0, 0.1f}, {0, 0.4f, 0}), add_material(scene, pane()));
    add_object(scene, quad({0.2f, 0.9f, -2.9f}, {0.6f, 0.1f, 0}, {0.1f, 0, 0.6f}), add_material(scene, pane()));
    MaterialDesc veil = gltf_plastic();
    veil.base_color = Rgb(1.0f);
    veil.base_color_texture.texture = color_texture;
    veil.normal_texture.texture = relief_texture;
    veil.alpha_mode = AlphaMode::Blend;
    add_object(scene, quad({0.1f, 0.4f, -2.4f}, {0.4f, 0, 0}, {0, 0.4f, 0}), add_material(scene, veil));
    add_object(scene, quad({0.1f, 0.4f, -2.6f}, {0.4f, 0, 0}, {0, 0.4f, 0}), add_material(scene, conductor(0.0f)));
    MaterialDesc cloth = gltf_plastic();
    cloth.base_color_texture.texture = color_texture;
    cloth.metallic = 0.5f;
    cloth.roughness = 0.3f;
    add_object(scene, quad({-0.9f, -0.3f, -3.4f}, {0.4f, 0, 0.1f}, {0, 0.4f, 0}), add_material(scene, cloth));
    // A block of glass that stands on the floor, and another, of a lower precedence, that reaches into it.
    const Mat4f standing = scaling({0.3f, 0.15f, 0.2f}) * translation({-0.3f, -0.55f, -2.6f});
    add_object(scene, cube(), add_material(scene, glass(0.0f, 1.0f, {0.9f, 0.6f, 0.3f})), standing);
    MaterialDesc resin = glass(0.0f, 0.0f, {0.3f, 0.8f, 0.5f});
    std::get<DielectricDesc>(resin.override_model).volume.priority = -1;
    add_object(scene, cube(), add_material(scene, resin), standing * translation({0.15f, 0.1f, 0.1f}));
    if (air == RoomAir::Resin) add_object(scene, sphere({0.0f, 1.3f, -3.0f}, 1.2f, 12), add_material(scene, resin));
    // A second lamp, so that lights are chosen by what they light.
    add_object(scene, quad({-1.2f, 0.2f, -2.8f}, {0, 0, -0.1f}, {0, 0.1f, 0}),
               add_material(scene, emissive(Rgb(9.0f))));
    MaterialDesc sign = gltf_plastic();
    sign.unlit = true;
    add_object(scene, quad({1.1f, -0.3f, -3.0f}, {0, 0, 0.8f}, {0, 0.4f, 0}), add_material(scene, sign));
    PrimitiveDesc ball = sphere(Vec3f(0.0f), 0.25f, 8);
    add_object(scene, std::move(ball), add_material(scene, conductor(0.2f)));
    scene.instances.back().motion = {translation({-0.5f, -0.4f, -2.8f}), translation({-0.2f, -0.3f, -2.7f})};
    add_object(scene, quad(Vec3f(0.0f), {0.1f, 0, 0}, {0, 0, 0.1f}), add_material(scene, emissive(Rgb(4.0f))));
    scene.instances.back().motion = {translation({0.9f, 0.3f, -2.8f}), translation({1.2f, 0.5f, -2.9f})};
    return compile(std::move(scene));
}

World divided_room() {
    SceneDesc scene = empty_scene();
    add_object(scene, cube(), add_material(scene, filling_of(RoomAir::Fog)));
    scene.instances.back().motion = {translation({-0.7f, -0.4f, -1.5f}), translation({0.6f, -0.2f, -1.3f})};
    add_object(scene, quad({0.3f, 0, -2.5f}, {1.5f, 0, 0.5f}, {0, 1.5f, 0}), add_material(scene, diffuse(Rgb(0.6f))));
    add_object(scene, quad({0, 1.4f, -1.5f}, {0.4f, 0, 0}, {0, 0, 0.4f}), add_material(scene, emissive(Rgb(5.0f))));
    add_environment(scene);
    scene.lights.push_back(point_light());
    CameraDesc& camera = scene.cameras.front();
    camera.lens_radius = 0.05f;
    camera.clip.start = 1.0f;
    camera.clip.end = 2.4f;
    camera.motion = {translation({0, 0, -0.3f}), translation({0.1f, 0, 0.3f})};
    return compile(std::move(scene));
}

World many_lights_room() {
    SceneDesc scene = empty_scene();
    add_room(scene);
    add_ball(scene, gltf_plastic());
    MaterialDesc varnished = gltf_plastic();
    varnished.clearcoat.factor = 1.0f;
    add_object(scene, sphere({-0.6f, -0.3f, -3.2f}, 0.3f, 12), add_material(scene, varnished));
    add_environment(scene);
    scene.lights.push_back(point_light());
    scene.lights.push_back(spot_light());
    scene.lights.push_back(sun_light());
    scene.lights.back().angle = 0.2f;
    for (const float z : {0.0f, 1.0f, 2.0f})
        for (const float x : {0.0f, 1.0f, 2.0f}) {
            add_object(scene, quad({x - 1.0f, 1.2f, -4.0f + z}, {0.05f, 0, 0}, {0, 0, 0.08f}),
                       add_material(scene, emissive({3.0f + 3.0f * x, 4.0f, 2.0f + 2.0f * z})));
        }
    return compile(std::move(scene));
}

}  // namespace etendue::test
