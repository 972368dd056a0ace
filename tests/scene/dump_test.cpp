#include "scene/scene_desc.h"
#include "scene/small_scene.h"

#include <gtest/gtest.h>

namespace etendue {
namespace {

TEST(Dump, NamesEverythingButBulkArrays) {
    SceneDesc scene = small_scene();
    scene.materials[0].override_model = ConductorDesc{"Au", 0.25f};
    scene.extensions_ignored = {"KHR_x"};
    const std::string text = dump(scene);
    for (const char* expected :
         {"scene \"small\"", "extensions ignored: KHR_x", "image 0 \"\": 2 x 2, image.png", "texture 0", "\"paper\"",
          "override conductor Au roughness 0.25", "1 triangles, 3 vertices, material 0, tangents, uv0, uv1, colours",
          "instance 0", "camera 0 \"main\": perspective yfov 0.8", "light 0 \"\": spot", "environment",
          "integrator path", "64 spp", "film: 1024 x 576", "colour: working space"}) {
        EXPECT_NE(text.find(expected), std::string::npos) << expected << "\n" << text;
    }
}

TEST(Dump, DiffersWhenTheSceneDoes) {
    SceneDesc scene = small_scene();
    const std::string before = dump(scene);
    scene.instances[0].to_world[3][1] = 2.0f;
    EXPECT_NE(dump(scene), before);
}

}  // namespace
}  // namespace etendue
