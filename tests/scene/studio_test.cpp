#include "scene/studio.h"

#include "scene/small_scene.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace etendue {
namespace {

/// Returns the irradiance of a surface with this normal.
double irradiance(const Vec3f& normal) {
    constexpr int kRows = 400;
    constexpr double kStep = double(kPi) / kRows;
    double sum = 0.0;
    for (int y = 0; y < kRows; ++y)
        for (int x = 0; x < 2 * kRows; ++x) {
            const double polar = (y + 0.5) * kStep;
            const double azimuth = (x + 0.5) * kStep;
            const Vec3f direction(float(std::sin(polar) * std::sin(azimuth)), float(std::cos(polar)),
                                  float(std::sin(polar) * std::cos(azimuth)));
            const double cosine = double(dot(direction, normal));
            if (cosine > 0.0) sum += double(studio_radiance(direction)) * cosine * std::sin(polar) * kStep * kStep;
        }
    return sum;
}

SceneDesc dark_scene() {
    SceneDesc scene = small_scene();
    scene.lights.clear();
    scene.environment = {};
    return scene;
}

const InstanceDesc* ground_of(const SceneDesc& scene) {
    const auto found = std::ranges::find(scene.instances, "studio ground", &InstanceDesc::name);
    return found == scene.instances.end() ? nullptr : &*found;
}

/// Returns the height of the ground, which is level.
float ground_height(const SceneDesc& scene) {
    return scene.meshes.at(std::size_t(ground_of(scene)->mesh.index)).primitives.at(0).positions.at(0).y;
}

TEST(Studio, ShowsGreyAsItIs) {
    EXPECT_NEAR(irradiance({0.0f, 1.0f, 0.0f}) / double(kPi), 1.0, 0.003);
    const double from_front = irradiance({0.0f, 0.0f, 1.0f}) / double(kPi);
    EXPECT_GT(from_front, 0.6);
    EXPECT_LT(from_front, 1.0);
    EXPECT_GT(irradiance(normalize(Vec3f(-1.0f, 0.0f, 1.0f))), 1.2 * irradiance(normalize(Vec3f(1.0f, 0.0f, 1.0f))))
        << "the key is on the left";
}

TEST(Studio, HasNoHorizon) {
    for (const float azimuth : {0.0f, 1.0f, 2.5f, 4.0f})
        for (const float y : {-1.0f, -0.5f, -0.01f, 0.01f, 0.05f}) {
            const float across = std::sqrt(1.0f - y * y);
            EXPECT_NEAR(studio_radiance({across * std::sin(azimuth), y, across * std::cos(azimuth)}), kStudioBackdrop,
                        0.01f);
        }
}

TEST(Studio, GroundIsBelowTheLowestVertex) {
    SceneDesc scene = dark_scene();
    // Turned upside down by 225 degrees, a corner of the triangle's box is lower than any vertex.
    const float s = std::sqrt(0.5f);
    scene.instances.at(0).to_world = Mat4f(-s, -s, 0, 0, s, -s, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1);
    float lowest = 1e9f;
    for (const Vec3f& p : scene.meshes.at(0).primitives.at(0).positions)
        lowest = std::min(lowest, transform_point(scene.instances[0].to_world, p).y);
    scene.cameras.at(0).to_world[3][1] = 100.0f;
    ProblemList problems;
    add_studio(scene, {}, problems);
    ASSERT_NE(ground_of(scene), nullptr);
    EXPECT_LT(ground_height(scene), lowest);
    EXPECT_NEAR(ground_height(scene), lowest, 0.01f);
    EXPECT_TRUE(problems.all().empty());
    EXPECT_FALSE(validate(scene).has_errors());
}

TEST(Studio, GroundFacesUp) {
    SceneDesc scene = dark_scene();
    scene.cameras.at(0).to_world[3][1] = 100.0f;
    ProblemList problems;
    add_studio(scene, {}, problems);
    for (const PrimitiveDesc& primitive : scene.meshes.at(std::size_t(ground_of(scene)->mesh.index)).primitives)
        for (const auto& t : primitive.triangles) {
            const Vec3f& a = primitive.positions.at(t[0]);
            EXPECT_GT(triangle_normal(primitive.positions.at(t[1]) - a, primitive.positions.at(t[2]) - a).y, 0.99f);
        }
}

TEST(Studio, HasNoGroundWhereNoneIsWanted) {
    SceneDesc scene = dark_scene();
    scene.cameras.at(0).to_world[3][1] = 100.0f;
    scene.settings.ground = false;
    ProblemList problems;
    add_studio(scene, {}, problems);
    EXPECT_EQ(ground_of(scene), nullptr);
    EXPECT_TRUE(scene.environment.is_studio);

    SceneDesc below = dark_scene();
    below.cameras.at(0).to_world[3][1] = -100.0f;
    add_studio(below, {}, problems);
    EXPECT_EQ(ground_of(below), nullptr);
    ASSERT_EQ(problems.all().size(), 1u);
    EXPECT_NE(problems.all()[0].message.find("camera is below"), std::string::npos);
}

TEST(Studio, KeepsHowTheEnvironmentIsTurnedAndSeen) {
    SceneDesc scene = dark_scene();
    scene.environment.image = "sky.exr";
    scene.environment.rotation = 1.0f;
    scene.environment.scale = 0.0f;
    scene.environment.visible_to_camera = false;
    ProblemList problems;
    add_studio(scene, {}, problems);
    EXPECT_TRUE(scene.environment.enabled);
    EXPECT_TRUE(scene.environment.is_studio);
    EXPECT_TRUE(scene.environment.image.empty());
    EXPECT_EQ(scene.environment.rotation, 1.0f);
    EXPECT_FALSE(scene.environment.visible_to_camera);
    EXPECT_EQ(scene.environment.scale, 1.0f) << "it shines in place of what is black";
    scene.environment.scale = 2.0f;
    add_studio(scene, {}, problems);
    EXPECT_EQ(scene.environment.scale, 2.0f);
}

TEST(Studio, GroundIsLeftOutBelowTheEyeThatIsGiven) {
    SceneDesc scene = dark_scene();
    scene.origin = {0.0, 1000.0, 0.0};
    scene.cameras.at(0).to_world[3][1] = 100.0f;
    scene.settings.camera_place = CameraPlace{.eye = {0.0, 900.0, 0.0}};
    ProblemList problems;
    add_studio(scene, {}, problems);
    EXPECT_EQ(ground_of(scene), nullptr);
    scene.settings.camera_place->eye.y = 1100.0;
    scene.cameras.at(0).to_world[3][1] = -100.0f;
    add_studio(scene, {}, problems);
    EXPECT_NE(ground_of(scene), nullptr);
}

}  // namespace
}  // namespace etendue
