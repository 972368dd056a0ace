#include "loader/gltf/gltf_builder.h"

#include <functional>

#include <gtest/gtest.h>

namespace etendue {
namespace {

/// A triangle in a cube map of six times the same pixel.
GltfBuilder with_cube(const std::function<void(nlohmann::json& light)>& change = [](nlohmann::json&) {}) {
    GltfBuilder builder;
    builder.add_triangle();
    nlohmann::json& light = builder.add_cube_map();
    light["intensity"] = 2.5;
    light["rotation"] = {0, 1, 0, 0};
    change(light);
    return builder;
}

TEST(ImageBasedLight, BecomesTheEnvironment) {
    const LoadedScene loaded = with_cube().load();
    EXPECT_TRUE(loaded.problems.all().empty()) << listing(loaded.problems);
    const EnvironmentDesc& environment = loaded.scene.environment;
    ASSERT_TRUE(environment.enabled);
    ASSERT_TRUE(environment.cube);
    EXPECT_EQ(environment.cube->intensity, 2.5f);
    EXPECT_EQ(environment.cube->faces[0].index, 0);
    EXPECT_EQ(environment.cube->faces[5].index, 5);
    EXPECT_LT(length(transform_vector(environment.cube->to_world, {1, 2, 3}) - Vec3f(-1, 2, -3)), 1e-6f);
    EXPECT_NE(dump(loaded.scene).find("environment cube map: images 0 1 2 3 4 5, intensity 2.5"), std::string::npos);
}

TEST(ImageBasedLight, OfAnotherSceneIsNotShown) {
    GltfBuilder builder = with_cube();
    builder.json["scenes"][0].erase("extensions");
    EXPECT_FALSE(builder.load().scene.environment.enabled);
}

TEST(ImageBasedLight, BelongsToTheSceneThatIsChosen) {
    const TempDir dir;
    GltfBuilder builder = with_cube();
    builder.json["scenes"][0]["name"] = "lit";
    builder.json["scenes"].push_back({{"name", "dark"}, {"nodes", {0}}});
    builder.write(dir);
    dir.write("render.json", R"({"scene_name": "dark"})");
    EXPECT_FALSE(inspect_scene(dir.path()).scene.environment.enabled);
    dir.write("render.json", R"({"scene_name": "lit"})");
    EXPECT_TRUE(inspect_scene(dir.path()).scene.environment.enabled);
}

TEST(ImageBasedLight, GivesWayToRenderJson) {
    const TempDir dir;
    with_cube().write(dir);
    dir.write("render.json", R"({"environment": {"color": [1, 2, 3]}})");
    const LoadedScene loaded = inspect_scene(dir.path());
    EXPECT_FALSE(loaded.scene.environment.cube);
    EXPECT_EQ(loaded.scene.environment.color, Rgb(1, 2, 3));
}

TEST(ImageBasedLight, BadOnesAreErrorsWithTheirPlace) {
    struct Case {
        std::function<void(nlohmann::json&)> change;
        Severity severity;
        const char* expected;
        const char* pointer;
    };
    const Case cases[] = {
        {[](auto& l) { l["specularImages"] = nlohmann::json::array(); }, Severity::Error, "at least 1 elements",
         "/lights/0/specularImages"},
        {[](auto& l) { l["specularImages"][0].erase(5); }, Severity::Error, "must have 6 elements",
         "/lights/0/specularImages/0"},
        {[](auto& l) { l["specularImages"][0][3] = 9; }, Severity::Error, "refers to number 9",
         "/lights/0/specularImages/0/3"},
        {[](auto& l) { l.erase("specularImages"); }, Severity::Error, "'specularImages' is missing", "/lights/0"},
        {[](auto& l) {
             l["rotation"] = {0, 0, 0};
         },
         Severity::Error, "must have 4 elements", "/lights/0/rotation"},
        {[](auto& l) { l["intensity"] = -1; }, Severity::Error, "must be a number", "/lights/0/intensity"},
        {[](auto& l) {
             l["rotation"] = {0, 0, 0, 0};
         },
         Severity::Warning, "zero quaternion", "/lights/0"},
        {[](auto& l) { l["specularImageSize"] = 256; }, Severity::Warning, "specularImageSize is 256", "/lights/0"},
    };
    for (const Case& c : cases) {
        const LoadedScene loaded = with_cube(c.change).load();
        EXPECT_TRUE(has_problem(loaded.problems, c.severity, c.expected, c.pointer)) << c.expected << ":\n"
                                                                                     << listing(loaded.problems);
    }
    GltfBuilder no_light = with_cube();
    no_light.json["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 1;
    EXPECT_TRUE(has_problem(no_light.load().problems, Severity::Error, "there are 1", "/light"));
}

}  // namespace
}  // namespace etendue
