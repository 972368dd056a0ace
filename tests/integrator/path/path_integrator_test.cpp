// Path lengths, transparency and agreement of the strategies, on scenes whose answer is known. Tolerances are 5
// standard errors where there is noise.
#include "integrator/path/path_integrator.h"

#include "integrator/closed_form_scene.h"
#include "integrator/render_tile.h"
#include "transport/roulette.h"
#include "world/test_scene.h"

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

/// Of means of samples without noise, relative to at most 2.
constexpr double kRounding = 1e-5;

PathIntegrator path_of(int max_depth, int min_depth = 1, bool sample_lights = true, int roulette_depth = 3) {
    return PathIntegrator(
        {.lengths = {max_depth, min_depth, roulette_depth}, .light_samples = sample_lights ? 1u : 0u});
}

SceneDesc with_environment(float radiance) {
    SceneDesc scene = empty_scene();
    scene.environment.enabled = true;
    scene.environment.color = Rgb(radiance);
    return scene;
}

/// The camera sits inside a polyhedron that emits `radiance` and reflects `albedo`: every further bounce adds the same.
SceneDesc glowing_sphere(float radiance, float albedo) {
    SceneDesc scene = empty_scene();
    MaterialDesc wall = diffuse(albedo);
    wall.emissive = Rgb(radiance);
    add(scene, sphere(Vec3f(0.0f), 2.0f, 2, Facing::Inwards), wall);
    return scene;
}

TEST(PathIntegrator, DepthCountsEdges) {
    // A closed furnace with emission E and albedo a: n edges bring E (1 + a + ... + a^(n-1)).
    const World world = compile(glowing_sphere(0.5f, 0.5f));
    double expected = 0.0;
    for (int depth = 1; depth <= 4; ++depth) {
        expected += 0.5 * std::pow(0.5, depth - 1);
        for (const bool sample_lights : {true, false}) {
            const TileResult all = render_tile(world, path_of(depth, 1, sample_lights), 256);
            EXPECT_NEAR(all.mean.g, expected, 5.0 * all.error + kRounding) << depth << " edges";
            const TileResult last = render_tile(world, path_of(depth, depth, sample_lights), 256);
            EXPECT_NEAR(last.mean.g, 0.5 * std::pow(0.5, depth - 1), 5.0 * last.error + kRounding) << "only " << depth;
        }
    }
}

TEST(PathIntegrator, RouletteDoesNotChangeTheMean) {
    const World world = compile(glowing_sphere(0.5f, 0.5f));
    for (const int roulette_depth : {1, 3}) {
        const TileResult result = render_tile(world, path_of(64, 1, true, roulette_depth), 512);
        EXPECT_NEAR(result.mean.g, 1.0, 5.0 * result.error + kRounding);
    }
}

TEST(PathIntegrator, RouletteTakesTheRootOfTheThroughput) {
    EXPECT_EQ(eye_path_survival(0.0f, most_survival(PathKind::Walk, 3)), 0.0f);
    EXPECT_EQ(eye_path_survival(0.25f, most_survival(PathKind::Walk, 3)), 0.5f);
    EXPECT_EQ(eye_path_survival(2.0f, most_survival(PathKind::Walk, kLongPath - 1)), 1.0f);
    EXPECT_EQ(eye_path_survival(2.0f, most_survival(PathKind::Walk, kLongPath)), 1.0f - 0.5f / kLongPath);
}

TEST(PathIntegrator, RouletteKeepsLightInGlass) {
    // Radiance is scaled by eta² going in and back going out; roulette must not see that. A lossless ball before a
    // constant environment is invisible.
    SceneDesc scene = with_environment(1.0f);
    MaterialDesc glass;
    glass.override_model = DielectricDesc{1.8f, 0.0f};
    add(scene, sphere({0, 0, -3}, 1.2f, 3, Facing::Outwards), glass);
    const World world = compile(std::move(scene));
    // Paths that are caught between facets end by chance, after 64 edges or many more. Roulette ends none before.
    std::vector<double> errors;
    for (const int roulette_depth : {1, 64}) {
        const TileResult result = render_tile(world, path_of(100000, 1, true, roulette_depth), 1024);
        EXPECT_NEAR(result.mean.g, 1.0, 5.0 * result.error + kRounding) << "roulette after " << roulette_depth;
        EXPECT_EQ(result.counters.dropped, 0u);
        errors.push_back(result.error);
    }
    EXPECT_NEAR(errors[0], errors[1], 1e-4);
}

TEST(PathIntegrator, AConvexBodyInAConstantEnvironmentShowsItsAlbedo) {
    SceneDesc scene = with_environment(2.0f);
    add(scene, sphere({0, 0, -2}, 1.9f, 2, Facing::Outwards), diffuse(Rgb(0.2f, 0.5f, 0.8f)));
    const World world = compile(std::move(scene));
    for (const bool sample_lights : {true, false})
        for (const SampleSequence sequence : {SampleSequence::Sobol, SampleSequence::Random}) {
            const TileResult result = render_tile(world, path_of(32, 1, sample_lights), 256, sequence);
            // The noise of a channel is in proportion to it; the error is of green.
            EXPECT_NEAR(result.mean.r, 0.4, 2.0 * result.error + kRounding);
            EXPECT_NEAR(result.mean.g, 1.0, 5.0 * result.error + kRounding);
            EXPECT_NEAR(result.mean.b, 1.6, 8.0 * result.error + kRounding);
        }
}

TEST(PathIntegrator, StrategiesAgreeOnALampAndAGlossyWall) {
    for (const float roughness : {0.2f, 0.6f, 1.0f}) {
        SceneDesc scene = empty_scene();
        MaterialDesc wall;
        wall.base_color = {0.9f, 0.6f, 0.3f};
        wall.metallic = 0.5f;
        wall.roughness = roughness;
        add_object(scene, quad({0, 0, -3}, {4, 0, 0}, {0, 4, 0}), add_material(scene, wall));
        add_object(scene, quad({0, 0.5f, -1}, {0, 0, -0.7f}, {0.7f, 0, 0}), add_material(scene, emissive(Rgb(8.0f))));
        const World world = compile(std::move(scene));
        const TileResult by_mis = render_tile(world, path_of(2, 2, true), 1024);
        const TileResult by_chance = render_tile(world, path_of(2, 2, false), 8192);
        EXPECT_GT(by_mis.mean.g, 0.01f);
        EXPECT_NEAR(by_mis.mean.g, by_chance.mean.g, 5.0 * std::hypot(by_mis.error, by_chance.error))
            << "roughness " << roughness;
        // Multiple importance sampling is there to lower the noise of as many samples.
        EXPECT_LT(by_mis.error, std::sqrt(8192.0 / 1024.0) * by_chance.error);
    }
}

// The choice between lamps depends on the surface: what samples of the BSDF meet must be weighed by the same choice.
TEST(PathIntegrator, StrategiesAgreeOnManyLampsAndAnySurface) {
    MaterialDesc plastic;
    plastic.base_color = {0.9f, 0.6f, 0.3f};
    plastic.metallic = 0.0f;
    plastic.roughness = 0.4f;
    MaterialDesc metal = plastic;
    metal.metallic = 1.0f;
    MaterialDesc anisotropic = metal;
    anisotropic.anisotropy.strength = 0.8f;
    MaterialDesc conductor;
    conductor.override_model = ConductorDesc{.metal = "Au", .roughness = 0.4f};
    MaterialDesc sheet = plastic;
    sheet.transmission = 0.5f;
    for (const auto& [name, wall] :
         {std::pair{"diffuse", diffuse(Rgb(0.6f))}, std::pair{"plastic", plastic}, std::pair{"metal", metal},
          std::pair{"anisotropic", anisotropic}, std::pair{"conductor", conductor}, std::pair{"sheet", sheet}}) {
        SceneDesc scene = empty_scene();
        add_object(scene, quad({0, 0, -3}, {4, 0, 0}, {0, 4, 0}), add_material(scene, wall));
        // Two before the wall, a weak one where the wall mirrors it, and one behind it.
        add_object(scene, quad({2.5f, 0, -1}, {0, 0, 0.8f}, {0, 0.8f, 0}), add_material(scene, emissive(Rgb(8.0f))));
        add_object(scene, quad({0, 2.5f, -1}, {0, 0, -0.8f}, {0.8f, 0, 0}), add_material(scene, emissive(Rgb(4.0f))));
        add_object(scene, quad({0, 0, 1}, {-0.8f, 0, 0}, {0, 0.8f, 0}), add_material(scene, emissive(Rgb(1.0f))));
        add_object(scene, quad({0, 0, -5}, {0.8f, 0, 0}, {0, 0.8f, 0}), add_material(scene, emissive(Rgb(20.0f))));
        const World world = compile(std::move(scene));
        const TileResult by_mis = render_tile(world, path_of(2, 2, true), 4096);
        const TileResult by_chance = render_tile(world, path_of(2, 2, false), 16384);
        EXPECT_GT(by_mis.mean.g, 0.01f) << name;
        EXPECT_NEAR(by_mis.mean.g, by_chance.mean.g, 5.0 * std::hypot(by_mis.error, by_chance.error)) << name;
        EXPECT_LT(by_mis.error, by_chance.error) << name;
        EXPECT_LT(by_chance.error, 0.01 * static_cast<double>(by_chance.mean.g)) << name;
    }
}

/// A body whose boundary does not refract.
MaterialDesc fog(const Rgb& multiscatter_color, float g) {
    MaterialDesc m;
    m.metallic = 0.0f;
    m.roughness = 0.0f;
    m.transmission = 1.0f;
    m.ior = 1.0f;
    m.volume = {.closed = true,
                .attenuation_color = {0.3f, 0.5f, 0.7f},
                .attenuation_distance = 0.8f,
                .multiscatter_color = multiscatter_color,
                .scatter_anisotropy = g};
    return m;
}

TEST(PathIntegrator, StrategiesAgreeOnALampInFog) {
    for (const float g : {-0.4f, 0.0f, 0.6f}) {
        SceneDesc scene = empty_scene();
        add_object(scene, sphere({0, 0, -3}, 2.0f, 16), add_material(scene, fog({0.8f, 0.9f, 0.6f}, g)));
        add_object(scene, sphere({0.3f, 0.2f, -3}, 0.4f, 8), add_material(scene, emissive({2.0f, 3.0f, 4.0f})));
        const World world = compile(std::move(scene));
        ASSERT_TRUE(world.traits().samples_lights_in_media);
        const TileResult by_mis = render_tile(world, path_of(100, 1, true), 1024);
        const TileResult by_chance = render_tile(world, path_of(100, 1, false), 1024);
        EXPECT_GT(by_mis.mean.g, 0.01f);
        EXPECT_NEAR(by_mis.mean.g, by_chance.mean.g, 5.0 * std::hypot(by_mis.error, by_chance.error)) << "g " << g;
    }
}

// A body many mean free paths thick, seen at right angles in diffuse light. The mapping from its colour to the albedo
// of one scattering is a fit, good to two hundredths.
TEST(PathIntegrator, ALargeSubsurfaceBodyReflectsItsAlbedo) {
    for (const float g : {0.0f, 0.5f}) {
        SceneDesc scene = with_environment(1.0f);
        MaterialDesc wax;
        wax.override_model =
            SubsurfaceDesc{.albedo = {0.2f, 0.5f, 0.8f}, .radius = Rgb(0.01f), .anisotropy = g, .ior = 1.0f};
        add_object(scene, sphere({0, 0, -30}, 20.0f, 64), add_material(scene, wax));
        const World world = compile(std::move(scene));
        const TileResult result = render_tile(world, path_of(100), 512);
        EXPECT_NEAR(result.mean.r, 0.2, 5.0 * result.error + 0.02) << "g " << g;
        EXPECT_NEAR(result.mean.g, 0.5, 5.0 * result.error + 0.02) << "g " << g;
        EXPECT_NEAR(result.mean.b, 0.8, 5.0 * result.error + 0.02) << "g " << g;
    }
}

// What a prism spreads is red on one side and blue on the other; without dispersion it has no colour at all.
TEST(PathIntegrator, ADispersiveBodySpreadsColours) {
    for (const float dispersion : {0.0f, 2.0f}) {
        SceneDesc scene = empty_scene();
        // Seen through the bottom of a thick wedge, the edge of a bright half-plane lies in another place for each
        // colour.
        MaterialDesc glass;
        glass.override_model = DielectricDesc{1.6f, 0.0f, {.closed = true, .dispersion = dispersion}};
        add_object(scene, sphere({0, 0, -3}, 1.5f, 64), add_material(scene, glass));
        add_object(scene, quad({5.05f, 0, -20}, {5, 0, 0}, {0, 10, 0}), add_material(scene, emissive(Rgb(1.0f))));
        const World world = compile(std::move(scene));
        const TileResult result = render_tile(world, path_of(20), 2048);
        const double spread = std::abs(static_cast<double>(result.mean.r - result.mean.b));
        EXPECT_GT(result.mean.g, 0.05f);
        if (dispersion == 0.0f)
            EXPECT_LT(spread, 1e-6);
        else
            EXPECT_GT(spread, 10.0 * result.error);
    }
}

TEST(PathIntegrator, PointLightsFollowTheInverseSquare) {
    SceneDesc scene = empty_scene();
    add_object(scene, quad({0, 0, -1}, {0.05f, 0, 0}, {0, 0.05f, 0}), add_material(scene, diffuse(Rgb(1.0f))));
    scene.cameras[0].yfov = 0.01f;
    LightDesc light;
    light.intensity = 12.0f;
    light.to_world = translation({0, 0, 1});
    scene.lights.push_back(light);
    const World world = compile(std::move(scene));
    // I / d² times albedo / pi.
    EXPECT_NEAR(render_tile(world, path_of(2), 4).mean.g, 12.0f / 4.0f * kInvPi, 1e-4f);
    // By chance a point is never found.
    EXPECT_EQ(render_tile(world, path_of(2, 1, false), 4).mean.g, 0.0f);
}

TEST(PathIntegrator, DirectLightIsBlockedByWhatStandsBetween) {
    SceneDesc scene = empty_scene();
    add_object(scene, quad({0, 0, -2}, {3, 0, 0}, {0, 3, 0}), add_material(scene, diffuse(Rgb(1.0f))));
    MaterialDesc screen = diffuse(Rgb(0.0f));
    screen.alpha_mode = AlphaMode::Blend;
    screen.base_alpha = 0.25f;
    // Behind the camera, before the light.
    add_object(scene, quad({0, 0, 1}, {9, 0, 0}, {0, 9, 0}), add_material(scene, screen));
    LightDesc sun;
    sun.type = LightType::Directional;
    sun.intensity = 4.0f;
    scene.lights.push_back(sun);
    const TileResult result = render_tile(compile(std::move(scene)), path_of(2), 1024);
    EXPECT_NEAR(result.mean.g, 4.0 * 0.75 / M_PI, 5.0 * result.error);
    EXPECT_GT(result.error, 0.0);
}

TEST(PathIntegrator, TranslucentSurfacesLetTheBackgroundThrough) {
    SceneDesc scene = with_environment(1.0f);
    scene.environment.visible_to_camera = false;
    MaterialDesc sheet = emissive(Rgb(3.0f));
    sheet.alpha_mode = AlphaMode::Blend;
    sheet.base_alpha = 0.4f;
    add_object(scene, quad({0, 0, -2}, {5, 0, 0}, {0, 5, 0}), add_material(scene, sheet));
    const TileResult result = render_tile(compile(std::move(scene)), path_of(1), 4096);
    EXPECT_NEAR(result.mean.g, 1.2, 5.0 * result.error);
    EXPECT_NEAR(result.alpha, 0.4, 5.0 * result.error / 3.0);
}

TEST(PathIntegrator, AnInvisibleEnvironmentStillLights) {
    for (const bool visible : {true, false}) {
        SceneDesc scene = with_environment(2.0f);
        scene.environment.visible_to_camera = visible;
        const TileResult empty = render_tile(compile(scene), path_of(8), 4);
        EXPECT_EQ(empty.mean, Rgb(visible ? 2.0f : 0.0f));
        EXPECT_EQ(empty.alpha, visible ? 1.0 : 0.0);
        add_object(scene, quad({0, 0, -2}, {5, 0, 0}, {0, 5, 0}), add_material(scene, diffuse(Rgb(0.5f))));
        const TileResult wall = render_tile(compile(scene), path_of(8), 256);
        EXPECT_NEAR(wall.mean.g, 1.0, 5.0 * wall.error + kRounding);
        EXPECT_EQ(wall.alpha, 1.0);
    }
}

// A window shows what lies behind it, and so nothing of an environment that the camera does not see; a mirror does.
TEST(Integrators, AnInvisibleEnvironmentIsNotSeenThroughPanes) {
    SceneDesc scene = with_environment(2.0f);
    scene.environment.visible_to_camera = false;
    MaterialDesc pane;
    pane.metallic = 0.0f;
    pane.roughness = 0.0f;
    pane.transmission = 1.0f;
    pane.specular = 0.0f;  // reflects nothing
    const auto handle = add_material(scene, pane);
    add_object(scene, quad({0, 0, -2}, {9, 0, 0}, {0, 9, 0}), handle);
    add_object(scene, quad({0, 0, -3}, {9, 0, 0}, {0, 9, 0}), handle);
    SceneDesc mirror = with_environment(2.0f);
    mirror.environment.visible_to_camera = false;
    MaterialDesc silver;
    silver.override_model = ConductorDesc{"", 0.0f};
    add_object(mirror, quad({0, 0, -2}, {9, 0, 0}, {0, 9, 0}), add_material(mirror, silver));
    const World behind_panes = compile(std::move(scene));
    const World in_mirror = compile(std::move(mirror));
    for (const char* name : {"path", "direct", "naive", "whitted", "bdpt"}) {
        const auto integrator = make_integrator(name, {.lengths = {.max_depth = 8}});
        const TileResult window = render_tile(behind_panes, *integrator, 4);
        EXPECT_EQ(window.mean, Rgb(0.0f)) << name;
        EXPECT_EQ(window.alpha, 0.0) << name;
        const TileResult reflected = render_tile(in_mirror, *integrator, 4);
        EXPECT_GT(reflected.mean.g, 1.0f) << name;
        EXPECT_EQ(reflected.alpha, 1.0) << name;
    }
}

TEST(PathIntegrator, UnlitSurfacesAreSeenButLightNothing) {
    SceneDesc scene = empty_scene();
    MaterialDesc unlit;
    unlit.unlit = true;
    unlit.base_color = Rgb(0.5f);
    const auto handle = add_material(scene, unlit);
    add_object(scene, quad({0, 0, -2}, {5, 0, 0}, {0, 5, 0}), handle);
    EXPECT_NEAR(render_tile(compile(scene), path_of(8), 1).mean.g, 0.5f, 1e-6f);
    // Behind the camera it does not reach a diffuse wall, but a mirror shows it.
    for (const bool mirror : {false, true}) {
        SceneDesc lit = empty_scene();
        MaterialDesc wall = diffuse(Rgb(1.0f));
        if (mirror) wall.override_model = ConductorDesc{"", 0.0f};
        add_object(lit, quad({0, 0, -2}, {5, 0, 0}, {0, 5, 0}), add_material(lit, wall));
        add_object(lit, quad({0, 0, 2}, {-9, 0, 0}, {0, 9, 0}), add_material(lit, unlit));
        EXPECT_NEAR(render_tile(compile(std::move(lit)), path_of(8), 16).mean.g, mirror ? 0.5f : 0.0f, 1e-5f);
    }
}

TEST(PathIntegrator, WithoutAnythingTheImageIsTransparentBlack) {
    const TileResult result = render_tile(compile(empty_scene()), path_of(8), 2);
    EXPECT_EQ(result.mean, Rgb(0.0f));
    EXPECT_EQ(result.alpha, 0.0);
}

TEST(PathIntegrator, LightSamplingOfSeveralLightsAddsThemUp) {
    // Each light alone, then all together: the choice by power must not weigh any twice.
    const auto scene_with = [](bool lamp, bool sun, bool sky) {
        SceneDesc scene = empty_scene();
        add_object(scene, quad({0, 0, -3}, {4, 0, 0}, {0, 4, 0}), add_material(scene, diffuse(Rgb(0.8f))));
        // It hides a little of the sky, on or off.
        add_object(scene, quad({0, 1.5f, -2}, {0.4f, 0, 0}, {0, 0, 0.4f}),
                   add_material(scene, emissive(Rgb(lamp ? 9.0f : 0.0f))));
        if (sun) {
            LightDesc light;
            light.type = LightType::Directional;
            scene.lights.push_back(light);
        }
        if (sky) {
            scene.environment.enabled = true;
            scene.environment.color = Rgb(0.3f);
        }
        return compile(std::move(scene));
    };
    double sum = 0.0;
    double variance = 0.0;
    for (const auto& [lamp, sun, sky] : {std::array{true, false, false}, {false, true, false}, {false, false, true}}) {
        const TileResult one = render_tile(scene_with(lamp, sun, sky), path_of(2, 2), 1024);
        sum += static_cast<double>(one.mean.g);
        variance += one.error * one.error;
    }
    const TileResult all = render_tile(scene_with(true, true, true), path_of(2, 2), 4096);
    EXPECT_NEAR(all.mean.g, sum, 5.0 * std::sqrt(variance + all.error * all.error));
}

}  // namespace

}  // namespace etendue::test
