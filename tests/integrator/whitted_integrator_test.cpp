// Whitted's ray tracing finds what path tracing does in two kinds of scenes: diffuse ones after one bounce, and ones of
// mirrors and smooth glass alone. (Its closed forms are in closed_form_test.cpp.)
#include "integrator/render_tile.h"
#include "integrator/scalar_integrators.h"
#include "world/test_scene.h"

#include <cmath>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr double kFiveSigma = 5.0;

MaterialDesc copper() {
    MaterialDesc m;
    m.override_model = ConductorDesc{"Cu", 0.0f};
    return m;
}

MaterialDesc glass(float dispersion) {
    MaterialDesc m;
    DielectricDesc desc{.ior = 1.5f, .roughness = 0.0f};
    desc.volume.dispersion = dispersion;
    desc.volume.attenuation_color = {0.9f, 0.6f, 0.3f};
    desc.volume.attenuation_distance = 0.5f;
    m.override_model = desc;
    return m;
}

MaterialDesc pane() {
    MaterialDesc m;
    m.base_color = {0.5f, 0.8f, 0.9f};
    m.metallic = 0.0f;
    m.roughness = 0.0f;
    m.transmission = 1.0f;
    m.clearcoat.factor = 0.7f;
    return m;
}

/// Fills most of the view.
void add_ball(SceneDesc& scene, const MaterialDesc& material, float radius = 0.6f) {
    add_object(scene, sphere({0.1f, 0.0f, -2.0f}, radius, 12), add_material(scene, material));
}

void add_lamp(SceneDesc& scene) {
    add_object(scene, quad({0, 1.3f, -2}, {0.5f, 0, 0}, {0, 0, 0.5f}), add_material(scene, emissive(Rgb(6.0f))));
}

/// Something to see all around.
void add_sky(SceneDesc& scene) {
    add_lamp(scene);
    scene.environment.enabled = true;
    scene.environment.color = {0.5f, 0.6f, 0.9f};
}

struct Room {
    const char* name;
    std::function<void(SceneDesc&)> make;
    PathLengths lengths;
};

void PrintTo(const Room& room, std::ostream* out) {
    *out << room.name;
}

class WhittedRooms : public testing::TestWithParam<Room> {};

TEST_P(WhittedRooms, ShowWhatPathTracingShows) {
    SceneDesc scene = empty_scene();
    GetParam().make(scene);
    const World world = compile(std::move(scene));
    const TileResult path = render_tile(world, *make_integrator("path", {.lengths = GetParam().lengths}), 4096);
    const TileResult whitted = render_tile(world, *make_integrator("whitted", {.lengths = GetParam().lengths}), 1024);
    const double difference = static_cast<double>(whitted.mean.g) - static_cast<double>(path.mean.g);
    EXPECT_GT(path.mean.g, 0.001f);
    EXPECT_LT(std::abs(difference), kFiveSigma * std::hypot(path.error, whitted.error) + 1e-5)
        << path.mean.g << " +- " << path.error << " against " << whitted.mean.g << " +- " << whitted.error;
    // Other channels by a bound, for the colours of dispersion and absorption.
    EXPECT_NEAR(whitted.mean.r, path.mean.r, 0.02f * path.mean.r);
    EXPECT_NEAR(whitted.mean.b, path.mean.b, 0.02f * path.mean.b);
    EXPECT_NEAR(whitted.alpha, path.alpha, 0.01);
}

const Room kWhittedRooms[] = {
    {"DirectLight",
     [](SceneDesc& scene) {
         add_ball(scene, diffuse({0.6f, 0.5f, 0.4f}));
         add_lamp(scene);
         LightDesc point;
         point.intensity = 2.0f;
         point.to_world = translation({0.6f, 0.9f, -0.5f});
         scene.lights.push_back(point);
     },
     {.max_depth = 2}},
    {"DirectLightThroughAVeil",
     [](SceneDesc& scene) {
         add_ball(scene, diffuse(Rgb(0.5f)));
         MaterialDesc veil = diffuse({0.3f, 0.6f, 0.3f});
         veil.alpha_mode = AlphaMode::Blend;
         veil.base_alpha = 0.5f;
         add_object(scene, quad({0.2f, 0.1f, -1.2f}, {0.4f, 0, 0}, {0, 0.4f, 0}), add_material(scene, veil));
         add_lamp(scene);
     },
     {.max_depth = 2}},
    {"Mirror",
     [](SceneDesc& scene) {
         add_ball(scene, copper());
         add_sky(scene);
     },
     {}},
    {"Glass",
     [](SceneDesc& scene) {
         add_ball(scene, glass(0.0f));
         add_ball(scene, glass(0.0f), 0.3f);
         add_sky(scene);
     },
     {}},
    {"GlassOfSomeLengths",
     [](SceneDesc& scene) {
         add_ball(scene, glass(0.0f));
         add_sky(scene);
     },
     {.max_depth = 5, .min_depth = 4}},
    {"Prism",
     [](SceneDesc& scene) {
         add_ball(scene, glass(4.0f));
         add_sky(scene);
     },
     {}},
    {"CoatedPane",
     [](SceneDesc& scene) {
         add_object(scene, quad({0, 0, -1.5f}, {0.8f, 0, 0.3f}, {0, 0.8f, 0}), add_material(scene, pane()));
         add_ball(scene, copper());
         add_sky(scene);
     },
     {}},
};

INSTANTIATE_TEST_SUITE_P(All, WhittedRooms, testing::ValuesIn(kWhittedRooms),
                         [](const auto& param) { return std::string(param.param.name); });

TEST(Whitted, FollowsBothRaysOfAnInterface) {
    // Before a white sky each camera ray of a glass ball brings all of its light, whatever the numbers.
    SceneDesc scene = empty_scene();
    MaterialDesc clear;
    clear.override_model = DielectricDesc{1.5f, 0.0f};
    add_object(scene, sphere({0, 0, -2}, 1.5f, 24), add_material(scene, clear));
    scene.environment.enabled = true;
    const World world = compile(std::move(scene));
    const TileResult whitted = render_tile(world, WhittedIntegrator({}), 64);
    EXPECT_NEAR(whitted.mean.g, 1.0f, 1e-3f);
    EXPECT_GT(whitted.counters.rays[RayKind::Bounce], 4 * whitted.counters.rays[RayKind::Primary]);
    EXPECT_EQ(whitted.counters.rays[RayKind::Shadow], 0u);
}

TEST(Whitted, LeavesIndirectLightOutAndSaysSo) {
    SceneDesc scene = empty_scene();
    add_ball(scene, diffuse(Rgb(0.8f)));
    add_object(scene, quad({0, -0.8f, -2}, {2, 0, 0}, {0, 0, -2}), add_material(scene, diffuse(Rgb(0.8f))));
    add_lamp(scene);
    const World world = compile(std::move(scene));
    const TileResult whitted = render_tile(world, WhittedIntegrator({}), 256);
    const TileResult direct = render_tile(world, *make_integrator("direct", {}), 256);
    const TileResult path = render_tile(world, *make_integrator("path", {}), 256);
    EXPECT_NEAR(whitted.mean.g, direct.mean.g, 5.0 * std::hypot(whitted.error, direct.error));
    EXPECT_LT(whitted.mean.g, path.mean.g);
    ASSERT_EQ(WhittedIntegrator({}).unreachable_light(world).size(), 1u);
    EXPECT_NE(WhittedIntegrator({}).unreachable_light(world)[0].find("indirect light"), std::string::npos);
}

}  // namespace

}  // namespace etendue::test
