#include "scene/scene_desc.h"
#include "scene/small_scene.h"

#include <gtest/gtest.h>

namespace etendue {
namespace {

TEST(Dump, NamesEverythingButBulkArrays) {
    SceneDesc scene = small_scene();
    scene.materials[0].override_model = ConductorDesc{"Au", 0.25f};
    scene.extensions_ignored = {"KHR_x"};
    scene.lights[0].profile.index = 0;
    scene.ies_profiles.push_back({"lamp.ies", {0, 1}, {0, 2 * kPi}, {1, 2, 3, 4}, {}});
    scene.environment.cube.emplace();
    scene.settings.light_units = LightUnits::Radiometric;
    const std::string text = dump(scene);
    for (const char* expected :
         {"scene \"small\"", "extensions ignored: KHR_x", "image 0 \"\": 2 x 2, image.png", "texture 0", "\"paper\"",
          "override conductor Au roughness 0.25", "1 triangles, 3 vertices, material 0, tangents, uv0, uv1, colours",
          "instance 0", "camera 0 \"main\": perspective yfov 0.8", "light 0 \"\": spot", "times IES profile 0",
          "IES profile 0 \"lamp.ies\": 2 x 2 directions, peak 4 cd", "environment cube map: images -1", "environment:",
          "light_units: \"radiometric\"", "integrator.type: \"auto\"", "spp: 64", "size: [1024, 576]"}) {
        EXPECT_NE(text.find(expected), std::string::npos) << expected << "\n" << text;
    }
}

TEST(Dump, DiffersWhenTheSceneDoes) {
    SceneDesc scene = small_scene();
    const std::string before = dump(scene);
    scene.instances[0].to_world[3][1] = 2.0f;
    EXPECT_NE(dump(scene), before);
}

TEST(Dump, SaysWhereThingsAreInTheWorld) {
    SceneDesc scene = small_scene();
    scene.origin = {5e6, 0.0, -250000.0};
    scene.instances[0].to_world[3][0] = 0.125f;
    scene.cameras[0].to_world[3][2] = 3.0f;
    const std::string text = dump(scene);
    EXPECT_NE(text.find("origin (5000000.125 0 -250000)"), std::string::npos) << text;
    EXPECT_NE(text.find("-249997)"), std::string::npos) << text;
}

TEST(Dump, NamesWhatDecidesHowTexturesAreRead) {
    SceneDesc scene = small_scene();
    EXPECT_EQ(dump(scene).find("texture_memory"), std::string::npos);
    scene.settings.texture_memory = 4u << 20;
    scene.textures[0].min_filter = TextureFilter::Nearest;
    scene.textures[0].mip_filter = TextureMipFilter::None;
    const std::string text = dump(scene);
    EXPECT_NE(text.find("texture_memory: \"4M\""), std::string::npos) << text;
    EXPECT_NE(text.find("minified nearest mip none"), std::string::npos) << text;
}

}  // namespace
}  // namespace etendue
