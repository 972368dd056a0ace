// Files that Blender 3.4 has written, where the folder with them is present.

#include "loader/gltf/gltf_builder.h"

#include <cmath>

#include <gtest/gtest.h>

namespace etendue {
namespace {

class BlenderCases : public testing::Test {
  protected:
    [[nodiscard]] static std::filesystem::path folder(const std::string& name) {
        return std::filesystem::path(ETENDUE_SHARED_ASSETS) / "../cases/blender" / name;
    }
    void SetUp() override {
        if (!std::filesystem::exists(folder(""))) GTEST_SKIP() << folder("") << " is not there";
    }
};

// The exporter writes an animation for each action: those of the armature, the shape keys, the cube and the camera.
TEST_F(BlenderCases, EveryActionPlays) {
    const auto at = [](double seconds) {
        const LoadOptions options{.adjust = [=](RenderSettings& settings) { settings.time_code = seconds; }};
        LoadedScene loaded = load_scene(folder("anim"), options);
        EXPECT_FALSE(has_problem(loaded.problems, Severity::Warning, "not played")) << listing(loaded.problems);
        return std::move(loaded.scene);
    };
    const SceneDesc before = at(0.0);
    const SceneDesc after = at(0.4);
    ASSERT_EQ(before.animations.size(), 4u);
    EXPECT_NE(before.cameras.at(0).to_world, after.cameras.at(0).to_world);
    const auto has_moved = [&](const std::string& name) {
        for (std::size_t i = 0; i < before.instances.size(); ++i) {
            const InstanceDesc& a = before.instances[i];
            const InstanceDesc& b = after.instances.at(i);
            const auto positions = [](const SceneDesc& scene, const InstanceDesc& instance) {
                return scene.meshes.at(static_cast<std::size_t>(instance.mesh.index)).primitives.at(0).positions;
            };
            if (a.name == name) return a.to_world != b.to_world || positions(before, a) != positions(after, b);
        }
        ADD_FAILURE() << "no " << name;
        return false;
    };
    for (const char* name : {"Tentacle", "Blob", "Mover"}) EXPECT_TRUE(has_moved(name)) << name;
    EXPECT_FALSE(has_moved("Floor"));
}

// Blender writes no KHR_materials_volume for the usual glass.
TEST_F(BlenderCases, GlassIsClosedByOneWord) {
    const auto glass_of = [](const std::string& settings) {
        const LoadedScene loaded = inspect_scene(folder("glass_default"), {.settings = settings});
        EXPECT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
        for (const MaterialDesc& material : loaded.scene.materials)
            if (material.name == "Glass") return material;
        return MaterialDesc();
    };
    EXPECT_FALSE(glass_of("").volume.closed);
    const MaterialDesc solid = glass_of(R"({"materials": {"Glass": {"solid": true}}})");
    EXPECT_TRUE(solid.volume.closed);
    EXPECT_EQ(solid.transmission, 1.0f);
    EXPECT_NEAR(solid.base_color.r, 0.8f, 1e-6f);
    const MaterialDesc dielectric = glass_of(R"({"materials": {"Glass": {"dielectric": {}}}})");
    EXPECT_NEAR(dielectric.base_color.r, 0.8f, 1e-6f) << "which tints what passes it, too";
}

TEST_F(BlenderCases, CamerasHaveTheNamesOfObjects) {
    const LoadedScene loaded = inspect_scene(folder("camnames"));
    for (const char* name : {"Hero shot", "Side shot", "Rig shot"})
        EXPECT_NE(find_camera(loaded.scene, name), nullptr) << name;
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Note, "the file has 3 cameras")) << listing(loaded.problems);
}

// The exporter drops the radius of lamps and the angle of suns.
TEST_F(BlenderCases, LampsBecomeSoftByOneWord) {
    const char* const soft = R"({"lights": {"Point": {"radius": 0.5}, "Sun": {"angle": 0.12}}})";
    const LoadedScene loaded = inspect_scene(folder("soft_lamps"), {.settings = soft});
    EXPECT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    EXPECT_FALSE(has_problem(loaded.problems, Severity::Note, "--light-units")) << "its lamps are raw numbers";
    ASSERT_EQ(loaded.scene.lights.size(), 1u);
    EXPECT_FLOAT_EQ(loaded.scene.lights[0].angle, 0.12f);
    EXPECT_EQ(loaded.scene.instances.back().name, "Point");
    // 150 W: 11.94 cd, over the disk that every side sees.
    EXPECT_NEAR(loaded.scene.materials.back().emissive_strength, 11.93662f / (0.25f * kPi), 1e-3f);
}

}  // namespace
}  // namespace etendue
