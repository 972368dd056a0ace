#include "loader/settings/lamp_surface.h"

#include "loader/settings/material_factors.h"

#include <utility>

namespace etendue {

void add_surface_lamp(const SurfaceLamp& lamp, SceneDesc& scene) {
    const auto last = [](const auto& things) { return static_cast<std::int32_t>(things.size()) - 1; };
    MaterialDesc& material = scene.materials.emplace_back();
    material.name = lamp.data_name;
    if (lamp.stops_light) {
        material.override_model = DiffuseDesc{.albedo = Rgb(0.0f)};
    } else {
        // A pane that reflects nothing: all integrators go on through it, and their shadow rays and connections, too.
        material.metallic = 0.0f;
        material.roughness = 0.0f;
        material.ior = 1.0f;
        material.specular = 0.0f;
        material.transmission = 1.0f;
    }
    material.beam = lamp.beam;
    material.visible_to_camera = lamp.visible_to_camera;
    material.location = lamp.location;
    set_emission(lamp.color, lamp.radiance, material);

    MeshDesc& mesh = scene.meshes.emplace_back();
    mesh.name = lamp.data_name;
    mesh.location = lamp.location;
    PrimitiveDesc& primitive = mesh.primitives.emplace_back();
    primitive.shape = lamp.shape;
    primitive.positions = lamp.shape.corners();
    primitive.material = {last(scene.materials)};
    primitive.location = lamp.location;

    InstanceDesc& instance = scene.instances.emplace_back();
    instance.name = lamp.name;
    instance.mesh = {last(scene.meshes)};
    instance.to_world = lamp.to_world;
    instance.motion = lamp.motion;
    instance.location = lamp.location;
    instance.node = lamp.node;
}

}  // namespace etendue
