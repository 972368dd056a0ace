#include "scene/small_scene.h"

namespace etendue {

SceneDesc small_scene() {
    SceneDesc scene;
    scene.name = "small";
    scene.file = "small.gltf";

    ImageDesc image;
    image.path = "image.png";
    image.width = 2;
    image.height = 2;
    scene.images.push_back(image);
    scene.textures.emplace_back().image.index = 0;
    MaterialDesc material;
    material.name = "paper";
    material.base_color_texture.texture.index = 0;
    scene.materials.push_back(material);

    PrimitiveDesc triangle;
    triangle.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    triangle.normals.assign(3, {0, 0, 1});
    triangle.tangents.assign(3, {1, 0, 0, 1});
    triangle.uv0.assign(3, {0, 0});
    triangle.uv1.assign(3, {0, 0});
    triangle.colors.assign(3, {1, 1, 1, 1});
    triangle.triangles = {{0, 1, 2}};
    triangle.material.index = 0;
    scene.meshes.emplace_back().primitives.push_back(triangle);
    scene.instances.emplace_back().mesh.index = 0;

    scene.cameras.emplace_back().name = "main";
    LightDesc light;
    light.type = LightType::Spot;
    scene.lights.push_back(light);
    scene.environment.enabled = true;
    return scene;
}

}  // namespace etendue
