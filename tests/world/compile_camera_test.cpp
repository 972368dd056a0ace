#include "world/compile_parts.h"
#include "world/test_scene.h"

#include <cmath>
#include <span>
#include <string>
#include <utility>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

TEST(CompileCamera, TheImagesShapeWinsAndTheVerticalFieldOfViewIsKept) {
    SceneDesc scene = empty_scene();
    scene.settings.film.width = 300;
    scene.settings.film.height = 100;
    scene.cameras[0].yfov = 1.0f;
    scene.cameras[0].aspect_ratio = 1.5f;
    const auto pinhole = std::get<PinholeCamera>(compile_camera(scene));
    EXPECT_FLOAT_EQ(pinhole.half_height, std::tan(0.5f));
    EXPECT_FLOAT_EQ(pinhole.half_width, 3.0f * std::tan(0.5f));
}

TEST(CompileCamera, MakesEachType) {
    SceneDesc scene = empty_scene();
    scene.cameras[0].lens_radius = 0.1f;
    scene.cameras[0].focus_distance = 3.0f;
    const auto lens = std::get<ThinLensCamera>(compile_camera(scene));
    EXPECT_EQ(lens.lens_radius, 0.1f);
    EXPECT_EQ(lens.focus_distance, 3.0f);
    scene.cameras[0].type = CameraType::Orthographic;
    scene.cameras[0].ymag = 2.0f;
    scene.settings.film.width = 8;
    const auto orthographic = std::get<OrthographicCamera>(compile_camera(scene));
    EXPECT_EQ(orthographic.half_height, 2.0f);
    EXPECT_EQ(orthographic.half_width, 4.0f);
}

TEST(CompileCamera, ShiftsByTheLongerSideOfTheViewAsItIsShown) {
    SceneDesc scene = empty_scene();
    scene.settings.film.width = 300;
    scene.settings.film.height = 200;
    scene.cameras[0].yfov = 1.0f;
    scene.cameras[0].shift = {0.1f, -0.25f};
    const float half_height = std::tan(0.5f);
    const auto wide = std::get<PinholeCamera>(compile_camera(scene));
    EXPECT_FLOAT_EQ(wide.center.x, 0.1f * 3.0f * half_height);
    EXPECT_FLOAT_EQ(wide.center.y, -0.25f * 3.0f * half_height);
    // Narrow pixels make it a portrait.
    scene.settings.film.pixel_aspect = 0.5f;
    const auto tall = std::get<PinholeCamera>(compile_camera(scene));
    EXPECT_FLOAT_EQ(tall.half_width, 0.75f * half_height);
    EXPECT_FLOAT_EQ(tall.half_height, half_height);
    EXPECT_FLOAT_EQ(tall.center.x, 0.1f * 2.0f * half_height);
    scene.cameras[0].type = CameraType::Orthographic;
    scene.cameras[0].ymag = 3.0f;
    EXPECT_FLOAT_EQ(std::get<OrthographicCamera>(compile_camera(scene)).center.y, -0.25f * 6.0f);
}

TEST(CompileCamera, HasClippingAndAperture) {
    SceneDesc scene = empty_scene();
    EXPECT_TRUE(std::isinf(clip_of(compile_camera(scene)).end));
    scene.cameras[0].clip = {0.5f, 7.0f};
    scene.cameras[0].lens_radius = 0.1f;
    scene.cameras[0].aperture = {.blades = 6, .rotation = 0.2f, .ratio = 1.5f};
    const Camera camera = compile_camera(scene);
    EXPECT_EQ(clip_of(camera).start, 0.5f);
    EXPECT_EQ(clip_of(camera).end, 7.0f);
    const auto lens = std::get<ThinLensCamera>(camera);
    EXPECT_EQ(lens.aperture.blades, 6);
    EXPECT_EQ(lens.aperture.rotation, 0.2f);
    EXPECT_EQ(lens.aperture.ratio, 1.5f);
}

TEST(CompileCamera, FisheyesTouchTheNearerEdgesOfTheImage) {
    SceneDesc scene = empty_scene();
    scene.settings.film.width = 300;
    scene.settings.film.height = 200;
    CameraDesc& camera = scene.cameras[0];
    camera.type = CameraType::Fisheye;
    camera.fov = 3.0f;
    const auto wide = std::get<FisheyeCamera>(compile_camera(scene));
    EXPECT_FLOAT_EQ(wide.half_width, 1.5f);
    EXPECT_FLOAT_EQ(wide.half_height, 1.0f);
    EXPECT_EQ(wide.half_angle, 1.5f);
    EXPECT_EQ(wide.mapping, FisheyeMapping::Equidistant);
    scene.settings.film.width = 100;
    camera.circle = 1.25f;
    camera.fisheye = FisheyeType::Equisolid;
    camera.clip.start = 0.5f;
    const auto tall = std::get<FisheyeCamera>(compile_camera(scene));
    EXPECT_FLOAT_EQ(tall.half_width, 0.8f);
    EXPECT_FLOAT_EQ(tall.half_height, 1.6f);
    EXPECT_EQ(tall.mapping, FisheyeMapping::Equisolid);
    EXPECT_EQ(tall.clip.start, 0.5f);
    camera.type = CameraType::Equirectangular;
    EXPECT_EQ(std::get<EquirectangularCamera>(compile_camera(scene)).clip.start, 0.5f);
}

TEST(CompileCamera, TakesTheNamedOneAndSuggestsTheNearest) {
    SceneDesc scene = empty_scene();
    scene.cameras.emplace_back().name = "close-up";
    scene.cameras[1].type = CameraType::Orthographic;
    EXPECT_TRUE(std::holds_alternative<PinholeCamera>(compile_camera(scene)));
    scene.settings.camera = "close-up";
    EXPECT_TRUE(std::holds_alternative<OrthographicCamera>(compile_camera(scene)));
    scene.settings.camera = "closeup";
    try {
        (void)compile_camera(scene);
        FAIL() << "an unknown camera was found";
    } catch (const SceneError& error) {
        EXPECT_NE(std::string(error.what()).find("'close-up'"), std::string::npos) << error.what();
    }
    scene.settings.camera.clear();
    scene.cameras.clear();
    EXPECT_THROW((void)compile_camera(scene), SceneError);
}

TEST(CompileCamera, StandsWhereTheSettingsPlaceIt) {
    SceneDesc scene = empty_scene();
    scene.origin = Vec3d(1e6, 0.0, 0.0);
    scene.cameras[0].motion = {Mat4f(), translation({1, 0, 0})};
    scene.settings.camera_place = CameraPlace{.eye = {1e6 + 2.0, 3.0, 5.0}, .target = {1e6 + 2.0, 3.0, 9.0}};
    const CameraPose pose = pose_of(compile_camera(scene));
    EXPECT_EQ(pose.position, Vec3f(2.0f, 3.0f, 5.0f));
    EXPECT_EQ(pose.forward, Vec3f(0.0f, 0.0f, 1.0f));
    EXPECT_EQ(pose.up, Vec3f(0.0f, 1.0f, 0.0f));
    EXPECT_EQ(pose.right, Vec3f(-1.0f, 0.0f, 0.0f));
    EXPECT_TRUE(compile_camera_motion(scene).empty()) << "it stands still";
    scene.settings.camera_place->up = {-2.0, 0.0, 1.0};  // what lies along the view counts for nothing
    EXPECT_EQ(pose_of(compile_camera(scene)).up, Vec3f(-1.0f, 0.0f, 0.0f));
}

TEST(WithCamera, IsTheWorldThatIsCompiledWithThatCamera) {
    SceneDesc scene = empty_scene();
    const auto material = add_material(scene, emissive({1.0f, 2.0f, 3.0f}));
    add_object(scene, sphere({0.0f, 0.0f, -3.0f}, 1.0f, 8), material);
    SceneDesc moved = scene;
    moved.settings.camera_place = CameraPlace{.eye = {0.5, 0.5, 4.0}, .target = {0.0, 0.0, -3.0}};
    World world = with_camera(compile(scene), moved);
    // Which may be done again, and of which the description needs nothing but the camera.
    SceneDesc view;
    view.cameras = moved.cameras;
    view.settings = moved.settings;
    world = with_camera(std::move(world), view);
    const World compiled = compile(moved);
    EXPECT_EQ(world.traits().has_emitting_surfaces, compiled.traits().has_emitting_surfaces);
    EXPECT_EQ(world.statistics().triangles, compiled.statistics().triangles);
    const auto distance = [](const World& where, const Ray& ray) {
        Hit hit;
        where.geometry().intersect(std::span(&ray, 1), std::span(&hit, 1), Coherence::Coherent);
        return hit.valid() ? hit.t : 0.0f;
    };
    Random random(3);
    int hits = 0;
    for (int i = 0; i < 200; ++i) {
        const Vec2f film = random.next_2d();
        const Ray ray = world.camera().generate_ray(film, {0.5f, 0.5f}, 0.0f);
        const Ray expected = compiled.camera().generate_ray(film, {0.5f, 0.5f}, 0.0f);
        EXPECT_EQ(ray.origin, expected.origin);
        EXPECT_EQ(ray.direction, expected.direction);
        EXPECT_EQ(distance(world, ray), distance(compiled, ray));
        hits += distance(world, ray) > 0.0f ? 1 : 0;
    }
    EXPECT_GT(hits, 10);
    EXPECT_LT(hits, 190);
}

}  // namespace

}  // namespace etendue::test
