#include "integrator/render_tile.h"
#include "integrator/scalar_integrators.h"
#include "world/test_scene.h"

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

SceneDesc wall(MaterialDesc material) {
    SceneDesc scene = empty_scene();
    add_object(scene, quad({0, 0, -2}, {5, 0, 0}, {0, 5, 0}), add_material(scene, std::move(material)));
    return scene;
}

TEST(DebugIntegrator, NormalsAreMappedToTheUnitCube) {
    const World world = compile(wall(diffuse(Rgb(0.5f))));
    const TileResult result = render_tile(world, NormalsIntegrator({}), 2);
    EXPECT_NEAR(result.mean.r, 0.5f, 1e-5f);
    EXPECT_NEAR(result.mean.g, 0.5f, 1e-5f);
    EXPECT_NEAR(result.mean.b, 1.0f, 1e-5f);
    EXPECT_EQ(result.alpha, 1.0);
    EXPECT_EQ(result.counters.rays.total(), result.counters.rays[RayKind::Primary]);
}

TEST(DebugIntegrator, AlbedoIsTheScatteredShare) {
    const World world = compile(wall(diffuse({0.2f, 0.5f, 0.8f})));
    const TileResult result = render_tile(world, AlbedoIntegrator({}), 2);
    EXPECT_NEAR(result.mean.r, 0.2f, 1e-4f);
    EXPECT_NEAR(result.mean.g, 0.5f, 1e-4f);
    EXPECT_NEAR(result.mean.b, 0.8f, 1e-4f);
}

TEST(DebugIntegrator, UnlitSurfacesShowTheirColour) {
    MaterialDesc material;
    material.unlit = true;
    material.base_color = {0.2f, 0.5f, 0.8f};
    const TileResult result = render_tile(compile(wall(material)), AlbedoIntegrator({}), 1);
    EXPECT_NEAR(result.mean.b, 0.8f, 1e-4f);
}

TEST(DebugIntegrator, NothingIsTransparentBlack) {
    const TileResult result = render_tile(compile(empty_scene()), NormalsIntegrator({}), 1);
    EXPECT_EQ(result.mean, Rgb(0.0f));
    EXPECT_EQ(result.alpha, 0.0);
}

}  // namespace

}  // namespace etendue::test
