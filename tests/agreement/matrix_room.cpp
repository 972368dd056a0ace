#include "agreement/matrix_room.h"

#include "integrator/agreement_room.h"
#include "world/test_scene.h"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace etendue::test {

namespace {

/// Neither begins nor ends where tiles do.
constexpr PixelRect kCrop{5, 6, 59, 44};

/// A body that camera and room fit in, and lamps stay out of.
constexpr float kAroundRoom = 3.4f;

/// Without a mip chain: eye paths of the one integrator would see less of it than light paths of the other.
Handle<TextureDesc> add_unfiltered(SceneDesc& scene, const std::filesystem::path& image) {
    const auto texture = add_texture(scene, image, RoomImages::kTextureSize, RoomImages::kTextureSize);
    scene.textures[static_cast<std::size_t>(texture.index)].mip_filter = TextureMipFilter::None;
    return texture;
}

MaterialDesc make_material(BodyMaterial material) {
    switch (material) {
        case BodyMaterial::Diffuse:
            return diffuse({0.7f, 0.6f, 0.3f});
        case BodyMaterial::Glossy:
            return gltf_plastic();
        case BodyMaterial::Conductor:
            return conductor(0.7f);
        case BodyMaterial::Dielectric:
            return glass(0.0f);
        case BodyMaterial::RoughDielectric:
            return glass(0.8f);
        case BodyMaterial::Mirror:
            return conductor(0.0f);
        case BodyMaterial::Pane: {
            MaterialDesc pane = gltf_plastic();
            pane.base_color = {0.9f, 0.6f, 0.4f};
            pane.transmission = 0.8f;
            pane.roughness = 0.0f;
            return pane;
        }
    }
    return {};
}

/// A closed box between two corners.
PrimitiveDesc block(const Vec3f& low, const Vec3f& high) {
    PrimitiveDesc all;
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-1.0f, 1.0f}) {
            Vec3f center = (low + high) * 0.5f;
            center[axis] = side < 0.0f ? low[axis] : high[axis];
            Vec3f x(0.0f);
            Vec3f y(0.0f);
            x[(axis + 1) % 3] = side * 0.5f * (high - low)[(axis + 1) % 3];
            y[(axis + 2) % 3] = 0.5f * (high - low)[(axis + 2) % 3];
            const PrimitiveDesc face = quad(center, x, y);
            const auto first = static_cast<std::uint32_t>(all.positions.size());
            all.positions.insert(all.positions.end(), face.positions.begin(), face.positions.end());
            for (const auto& [a, b, c] : face.triangles) all.triangles.push_back({first + a, first + b, first + c});
        }
    return all;
}

/// A ball whose normals are what the room is about.
void add_body(SceneDesc& scene, const RoomTraits& room, const RoomImages& images) {
    MaterialDesc material = make_material(room.material);
    if (room.normals == BodyNormals::Mapped) material.normal_texture.texture = add_unfiltered(scene, images.normals());
    if (room.material == BodyMaterial::Pane) {
        PrimitiveDesc pane = quad({0.0f, 0.6f, -2.7f}, {0.7f, 0.1f, 0.0f}, {0.1f, 0.0f, 0.7f});
        return add_object(scene, std::move(pane), add_material(scene, std::move(material)));
    }
    if (room.normals == BodyNormals::Touching)
        return add_object(scene, block({-0.4f, -0.7f, -4.4f}, {0.7f, 0.1f, -3.3f}),
                          add_material(scene, std::move(material)));
    // Coarse, so that shading normals are far from those of the triangles.
    PrimitiveDesc ball = sphere(Vec3f(0.0f), 1.0f, room.normals == BodyNormals::Smooth ? 5 : 8);
    if (room.normals == BodyNormals::Flat) ball.normals.clear();
    ball.material = add_material(scene, std::move(material));
    const auto mesh = add_mesh(scene, {ball});
    const bool seen = room.body_is_seen();
    const Mat4f to_world = seen ? scaling(Vec3f(0.5f)) * translation({0.15f, -0.2f, -2.9f})
                                : scaling(Vec3f(0.3f)) * translation({0.0f, 0.78f, -2.6f});
    if (room.normals != BodyNormals::NegativeScale) return place(scene, mesh, to_world);
    // Placed twice, so that both are instances of one BVH.
    place(scene, mesh, scaling({-1.1f, 0.8f, 1.0f}) * to_world);
    place(scene, mesh, scaling({0.4f, 0.4f, -0.4f}) * to_world * translation({0.85f, seen ? -0.2f : 0.2f, -0.2f}));
}

MaterialDesc textured_lamp(SceneDesc& scene, const RoomImages& images, float radiance) {
    MaterialDesc lamp = emissive(Rgb(radiance));
    lamp.emissive_texture.texture = add_unfiltered(scene, images.emission());
    return lamp;
}

/// A flat lamp that shines down, `half` its width.
void add_area_light(SceneDesc& scene, const Vec3f& center, float half, float radiance, const Mat4f& mirror = Mat4f()) {
    add_object(scene, quad(Vec3f(0.0f), {half, 0, 0}, {0, 0, half}), add_material(scene, emissive(Rgb(radiance))),
               mirror * translation(center));
}

/// A bowl that shines down and to the sides, and a smaller one.
void add_mesh_light(SceneDesc& scene, const RoomImages& images, const Mat4f& mirror) {
    PrimitiveDesc bowl = sphere(Vec3f(0.0f), 1.4f, 8);
    std::erase_if(bowl.triangles, [&](const auto& triangle) {
        return bowl.positions[triangle[0]].y + bowl.positions[triangle[1]].y + bowl.positions[triangle[2]].y > 0.0f;
    });
    bowl.material = add_material(scene, textured_lamp(scene, images, 4.0f));
    const auto mesh = add_mesh(scene, {bowl});
    place(scene, mesh, mirror * scaling({1.2f, 0.8f, 1.0f}) * translation({-0.4f, 2.6f, -2.6f}));
    place(scene, mesh, mirror * scaling(Vec3f(0.3f)) * translation({1.6f, 1.4f, -2.8f}));
}

void add_sky(SceneDesc& scene, const RoomImages& images, bool visible) {
    add_environment(scene);
    scene.environment.image = images.environment();
    scene.environment.rotation = 0.7f;
    scene.environment.visible_to_camera = visible;
}

void add_light_in_room(SceneDesc& scene, const RoomTraits& room, const RoomImages& images) {
    // Emission has a side, which a negative scale must not change.
    const Mat4f mirror = room.normals == BodyNormals::NegativeScale ? scaling({-1, 1, 1}) : Mat4f();
    switch (room.light) {
        case RoomLight::Area:
            if (room.normals == BodyNormals::Touching)  // flush with a ceiling
                add_object(scene, quad({0.1f, 1.5f, -3}, {1.5f, 0, 0}, {0, 0, 1.4f}),
                           add_material(scene, diffuse(Rgb(0.5f))));
            return add_area_light(scene, {0, 1.5f, -3}, 1.2f, 3.0f, mirror);
        case RoomLight::Point:
            return scene.lights.push_back(point_light());
        case RoomLight::Spot:
            return scene.lights.push_back(spot_light());
        case RoomLight::Directional:
            return scene.lights.push_back(sun_light());
        case RoomLight::Environment:
            return add_sky(scene, images, false);
        case RoomLight::Mesh:
            return add_mesh_light(scene, images, mirror);
        case RoomLight::VisibleEnvironment:
            return add_sky(scene, images, true);
    }
}

/// Lights of media rooms: where no body of radius kAroundRoom reaches, or in a ball of radius 0.5 at `center`.
void add_light_above(SceneDesc& scene, RoomLight light_kind, const RoomImages& images) {
    switch (light_kind) {
        case RoomLight::Area:
            return add_area_light(scene, {0, 4.2f, -2.4f}, 2.5f, 4.0f);
        case RoomLight::Point:
            return scene.lights.push_back(light(LightType::Point, 120.0f, translation({0.6f, 8.0f, -2.4f})));
        default:
            return add_sky(scene, images, false);
    }
}

void add_light_in_ball(SceneDesc& scene, RoomLight light_kind, const Vec3f& center) {
    if (light_kind == RoomLight::Area) return add_area_light(scene, center, 0.25f, 10.0f);
    scene.lights.push_back(light(LightType::Point, 2.0f, translation(center)));
}

MaterialDesc make_medium(RoomMedium medium, float ior, float roughness, float distance) {
    DielectricDesc desc{.ior = ior, .roughness = roughness};
    if (medium != RoomMedium::Clear) desc.volume.attenuation_distance = distance;
    desc.volume.attenuation_color = {0.4f, 0.45f, 0.5f};
    if (medium == RoomMedium::Scattering) desc.volume.multiscatter_color = {0.5f, 0.6f, 0.4f};
    desc.volume.scatter_anisotropy = 0.3f;
    MaterialDesc material;
    material.override_model = desc;
    return material;
}

void add_medium(SceneDesc& scene, const RoomTraits& room, const RoomImages& images) {
    // What light has to cross is rough, so that all of its ways can be found, or clear under a light that is
    // everywhere. Fog begins without a surface.
    const auto fill = [&](const Vec3f& center, float radius, float ior, float roughness, float distance) {
        add_object(scene, sphere(center, radius, 12),
                   add_material(scene, make_medium(room.medium, ior, roughness, distance)));
    };
    constexpr float kRough = 0.9f;
    const Vec3f ball(0.15f, -0.1f, -2.9f);
    switch (room.place) {
        case MediumPlace::CameraIn:
            fill({0, 0.2f, -2.4f}, kAroundRoom, 1.5f, room.medium == RoomMedium::Clear ? 0.0f : kRough, 16.0f);
            return add_light_above(scene, room.light, images);
        case MediumPlace::LightIn:
            fill(ball, 0.5f, 1.3f, kRough, 1.5f);
            return add_light_in_ball(scene, room.light, ball);
        case MediumPlace::BothIn:
            fill({0, 0, -2}, 6.0f, 1.00001f, 0.0f, 12.0f);
            return add_light_in_room(scene, room, images);
        case MediumPlace::Between:
            fill(ball, 0.8f, 1.0f, 0.0f, 1.5f);
            return add_light_in_room(scene, room, images);
    }
}

void set_camera(CameraDesc& camera, const RoomTraits& room) {
    // Below the body, if that is not to be seen.
    if (!room.body_is_seen()) {
        camera.to_world = translation({0.0f, -0.3f, 0.0f});
        camera.yfov = 0.45f;
    }
    if (room.camera == RoomCamera::Orthographic) {
        camera.type = CameraType::Orthographic;
        camera.ymag = room.body_is_seen() ? 1.2f : 0.5f;
    } else if (room.camera == RoomCamera::ThinLens) {
        camera.lens_radius = 0.1f;
        camera.focus_distance = 3.0f;
    }
}

}  // namespace

AgreementCase make_case(const RoomTraits& room, const RoomImages& images) {
    AgreementCase result{.name = name_of(room), .make = [room, &images](SceneDesc& scene) {
                             set_camera(scene.cameras[0], room);
                             if (room.medium != RoomMedium::None && room.place == MediumPlace::LightIn)
                                 return add_medium(scene, room, images);
                             add_body(scene, room, images);
                             if (room.medium != RoomMedium::None) return add_medium(scene, room, images);
                             add_light_in_room(scene, room, images);
                         }};
    // Light by way of a body that it passes through has four edges. Roulette begins before the end.
    const bool passes = room.medium != RoomMedium::None || room.material == BodyMaterial::Dielectric ||
                        room.material == BodyMaterial::RoughDielectric;
    result.lengths = {.max_depth = passes ? 4 : 3, .roulette_depth = 2};
    // Two edges: eye paths do not find what a pane reflects of a point, and light goes through it without one.
    if (room.material == BodyMaterial::Pane) result.lengths = {.max_depth = 2};
    if (room.cropped) result.window = kCrop;
    result.integrators = finders_of(room);
    return result;
}

}  // namespace etendue::test
