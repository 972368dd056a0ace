#include "world/compile_parts.h"
#include "world/test_scene.h"

#include <cmath>
#include <string>

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

}  // namespace

}  // namespace etendue::test
