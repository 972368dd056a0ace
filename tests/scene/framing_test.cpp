#include "scene/scene_desc.h"
#include "scene/small_scene.h"

#include <algorithm>
#include <array>
#include <limits>

#include <gtest/gtest.h>

namespace etendue {
namespace {

SceneDesc bare_scene() {
    SceneDesc scene = small_scene();
    scene.cameras.clear();
    scene.lights.clear();
    scene.environment = {};
    return scene;
}

TEST(ComputeBounds, CoversAllInstances) {
    SceneDesc scene = bare_scene();
    InstanceDesc second = scene.instances[0];
    second.to_world[3][0] = 10.0f;
    second.to_world[1][1] = -2.0f;
    scene.instances.push_back(second);
    const Bounds bounds = compute_bounds(scene);
    EXPECT_EQ(bounds.min, Vec3f(0, -2, 0));
    EXPECT_EQ(bounds.max, Vec3f(11, 1, 0));
}

TEST(ChooseOrigin, IsTheWorldsForWhatIsNear) {
    EXPECT_EQ(choose_origin({}), Vec3d(0.0));
    EXPECT_EQ(choose_origin({Vec3f(-1.0f), Vec3f(1.0f)}), Vec3d(0.0));
    EXPECT_EQ(choose_origin({Vec3f(125.0f), Vec3f(127.0f)}), Vec3d(0.0)) << "63 times its size away";
    const float infinite = std::numeric_limits<float>::infinity();
    EXPECT_EQ(choose_origin({Vec3f(-infinite), Vec3f(infinite)}), Vec3d(0.0));
}

TEST(ChooseOrigin, IsARoundPlaceNearWhatIsFar) {
    EXPECT_EQ(choose_origin({Vec3f(129.0f, 0.0f, -1.0f), Vec3f(131.0f, 0.5f, 1.0f)}), Vec3d(132, 0, 0));
    EXPECT_EQ(choose_origin({Vec3f(4999999, -4, 99), Vec3f(5000002, -1, 102)}), Vec3d(5e6, 0, 104));
    // A triangle that single precision has made a point.
    const Vec3f far(0x1p40f, 0.0f, 0.0f);
    EXPECT_EQ(choose_origin({far, far}), Vec3d(far));
}

TEST(ComputeBounds, IgnoresWhatDoesNotExist) {
    SceneDesc scene = bare_scene();
    scene.instances[0].mesh.index = 5;
    EXPECT_TRUE(compute_bounds(scene).empty());
}

/// Largest |x| and |y| of the box's corners in the frame, where 1 is its edge; 2 if one is behind the camera.
std::array<float, 2> extent_in_frame(const SceneDesc& scene) {
    const Bounds bounds = compute_bounds(scene);
    const CameraDesc& camera = scene.cameras.at(0);
    const Mat4f to_camera = camera.to_world.inverse();
    const float tan_y = std::tan(camera.yfov / 2);
    const float tan_x = tan_y * float(scene.settings.film.width) / float(scene.settings.film.height);
    std::array<float, 2> extent{0, 0};
    for (int i = 0; i < 8; ++i) {
        const Vec3f corner((i & 1) ? bounds.max.x : bounds.min.x, (i & 2) ? bounds.max.y : bounds.min.y,
                           (i & 4) ? bounds.max.z : bounds.min.z);
        const Vec3f p = transform_point(to_camera, corner);
        if (p.z >= 0.0f) return {2, 2};
        extent[0] = std::max(extent[0], std::abs(p.x / -p.z / tan_x));
        extent[1] = std::max(extent[1], std::abs(p.y / -p.z / tan_y));
    }
    return extent;
}

TEST(AddMissing, CameraFramesTheBoxTightly) {
    for (const auto [width, height] : {std::array{1024, 576}, std::array{300, 900}, std::array{64, 64}}) {
        for (const Vec3f& size : {Vec3f(1, 1, 1), Vec3f(10, 0.1f, 0.1f), Vec3f(0.01f, 5, 0.01f), Vec3f(1, 2, 50)}) {
            SceneDesc scene = bare_scene();
            scene.settings.film.width = width;
            scene.settings.film.height = height;
            scene.meshes[0].primitives[0].positions = {Vec3f(3, 4, 5), Vec3f(3, 4, 5) + size, Vec3f(3, 4, 5)};
            ProblemList problems;
            scene.settings.ground = false;  // it is no part of what the camera frames
            add_missing_camera_and_light(scene, problems);
            const auto [x, y] = extent_in_frame(scene);
            EXPECT_LE(std::max(x, y), 1.0f);
            EXPECT_GE(std::max(x, y), 0.8f);
            EXPECT_EQ(problems.all().size(), 2u);
            EXPECT_FALSE(validate(scene).has_errors());
            EXPECT_GT(scene.cameras[0].to_world[2][0], 0.0f);  // from the right
            EXPECT_GT(scene.cameras[0].to_world[2][1], 0.0f);  // from above
            EXPECT_GT(scene.cameras[0].to_world[2][2], 0.5f);  // from the front
        }
    }
}

TEST(AddMissing, WorksForAnEmptyScene) {
    SceneDesc scene;
    ProblemList problems;
    add_missing_camera_and_light(scene, problems);
    EXPECT_EQ(scene.cameras.size(), 1u);
    EXPECT_TRUE(scene.environment.enabled);
    EXPECT_FALSE(validate(scene).has_errors());
}

TEST(AddMissing, LeavesWhatIsThere) {
    SceneDesc scene = small_scene();
    ProblemList problems;
    add_missing_camera_and_light(scene, problems);
    EXPECT_EQ(scene.cameras.size(), 1u);
    EXPECT_EQ(scene.cameras[0].name, "main");
    EXPECT_TRUE(problems.all().empty());
}

TEST(AddMissing, StudioIfItIsAskedFor) {
    SceneDesc lit = small_scene();
    lit.settings.studio = true;
    lit.environment.enabled = true;
    lit.environment.image = "sky.exr";
    ProblemList problems;
    add_missing_camera_and_light(lit, problems);
    EXPECT_TRUE(lit.environment.is_studio);
    EXPECT_TRUE(lit.environment.image.empty());
    EXPECT_FALSE(lit.lights.empty()) << "lamps stay";

    SceneDesc dark = bare_scene();
    dark.settings.studio = false;
    add_missing_camera_and_light(dark, problems);
    EXPECT_FALSE(dark.environment.enabled);
    EXPECT_NE(problems.all().back().message.find("the image is black"), std::string::npos);

    SceneDesc unlit = bare_scene();
    unlit.settings.studio = false;
    unlit.materials.emplace_back().unlit = true;
    unlit.meshes.at(0).primitives.at(0).material.index = static_cast<int>(unlit.materials.size()) - 1;
    add_missing_camera_and_light(unlit, problems);
    EXPECT_NE(problems.all().back().message.find("only unlit surfaces"), std::string::npos);
}

TEST(AddMissing, HintsAtTheStudioWhereOnlyAModelGlows) {
    const auto hints = [](SceneDesc scene) {
        scene.materials.at(0).emissive = Rgb(1.0f);
        ProblemList problems;
        add_missing_camera_and_light(scene, problems);
        return std::ranges::any_of(problems.all(), [](const Problem& problem) {
            return problem.message.find("--studio adds a studio") != std::string::npos;
        });
    };
    EXPECT_TRUE(hints(bare_scene()));
    SceneDesc set = bare_scene();
    set.cameras = small_scene().cameras;
    EXPECT_FALSE(hints(set)) << "what has a camera is meant to look as it does";
}

TEST(AddMissing, StudioOnlyIfNothingEmits) {
    const auto adds_studio = [](SceneDesc scene) {
        ProblemList problems;
        add_missing_camera_and_light(scene, problems);
        return scene.environment.is_studio;
    };
    EXPECT_TRUE(adds_studio(bare_scene()));

    SceneDesc lit = bare_scene();
    lit.lights.emplace_back();
    EXPECT_FALSE(adds_studio(lit));
    lit.lights[0].intensity = 0.0f;
    EXPECT_TRUE(adds_studio(lit));

    SceneDesc glowing = bare_scene();
    glowing.materials[0].emissive = Rgb(1.0f);
    EXPECT_FALSE(adds_studio(glowing));
    glowing.instances.clear();  // the material is there, but nothing with it
    EXPECT_TRUE(adds_studio(glowing));
}

}  // namespace
}  // namespace etendue
