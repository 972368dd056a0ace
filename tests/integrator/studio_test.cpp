// The studio, in which all integrators see the same, and shadow catchers, which stand for a ground that is elsewhere.
#include "scene/studio.h"

#include "core/error.h"
#include "image/write.h"
#include "integrator/agreement_render.h"
#include "integrator/closed_form_scene.h"
#include "integrator/integrator.h"
#include "support/chi2.h"
#include "support/temporary_folder.h"
#include "world/test_scene.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <numeric>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {
namespace {

/// A camera at `eye` that looks at `target`.
void look_at(SceneDesc& scene, const Vec3f& eye, const Vec3f& target) {
    CameraDesc& camera = scene.cameras.at(0);
    const Vec3f z = normalize(eye - target);
    const Vec3f x = normalize(cross(Vec3f(0.0f, 1.0f, 0.0f), z));
    const Vec3f y = cross(z, x);
    camera.to_world = Mat4f(x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, eye.x, eye.y, eye.z, 1);
    camera.yfov = 0.8f;
}

/// Makes a diffuse ball, a mirroring ball and a ball of glass in the studio.
SceneDesc balls_in_studio() {
    SceneDesc scene = empty_scene();
    MaterialDesc mirror;
    mirror.override_model = ConductorDesc{.metal = "Ag", .roughness = 0.3f};
    MaterialDesc glass;
    glass.override_model = DielectricDesc{};
    add_object(scene, sphere({-1.1f, 0.5f, 0.0f}, 0.5f, 12), add_material(scene, diffuse(Rgb(0.6f, 0.3f, 0.2f))));
    add_object(scene, sphere({0.0f, 0.5f, 0.0f}, 0.5f, 12), add_material(scene, mirror));
    add_object(scene, sphere({1.1f, 0.5f, 0.0f}, 0.5f, 12), add_material(scene, glass));
    look_at(scene, {0.5f, 1.5f, 4.5f}, {0.0f, 0.3f, 0.0f});
    ProblemList problems;
    add_studio(scene, {}, problems);
    return scene;
}

/// Holds the image of `world` by `integrator` against that by `path`, by a test of which 1 in 1,000 tables of three
/// fails by chance.
void expect_image_of_path(const World& world, const std::string& integrator, std::uint32_t spp, std::uint32_t seed) {
    constexpr int kIntegrators = 3;
    AgreementCase room{.name = "room", .make = {}, .lengths = {.max_depth = 6}};
    room.spp = spp;
    const ThreadPool threads;
    const BlockAgreement result = test_agreement(
        estimate(world, "path", room, {.first_seed = seed}, threads),
        estimate(world, integrator, room, {.first_seed = seed + 100}, threads),
        {.block_size = kAgreementBlock, .significance = sidak_level(1e-3, kIntegrators), .mean_tolerance = 0.02});
    EXPECT_TRUE(result.agree()) << result.str();
}

class Studio : public testing::TestWithParam<const char*> {};

TEST_P(Studio, IntegratorsAgree) {
    expect_image_of_path(compile(balls_in_studio()), GetParam(), 12, 700);
}

INSTANTIATE_TEST_SUITE_P(Integrators, Studio, testing::Values("naive", "bdpt", "vcm"),
                         [](const auto& run) { return std::string(run.param); });

TEST(StudioGround, ShowsTheBackdropWhereNothingShadowsIt) {
    SceneDesc scene = balls_in_studio();
    const ThreadPool threads;
    AgreementCase studio{.name = "studio", .make = {}};
    studio.spp = 64;
    // Above the balls and beside them: the environment, the ground that fades, and the ground itself, far from shadows.
    look_at(scene, {0.0f, 1.5f, 6.0f}, {0.0f, 1.5f, -100.0f});
    scene.instances.erase(scene.instances.begin(), scene.instances.begin() + 3);
    const World world = compile(scene);
    const ImageEstimate image = estimate(world, "path", studio, {.seeds = 2}, threads);
    double sum = 0.0;
    for (std::size_t i = 0; i < image.mean.pixels.size(); ++i) {
        ASSERT_NEAR(image.mean.pixels[i], kStudioBackdrop, 0.08f) << i;
        sum += double(image.mean.pixels[i]);
    }
    EXPECT_NEAR(sum / double(image.mean.pixels.size()), double(kStudioBackdrop), 0.002);
}

// ---- Shadow catchers.

constexpr float kGroundAlbedo = 0.5f;
constexpr int kCatcherSide = 24;  ///< pixels

/// A ball over a ground, under a lamp and a sky.
SceneDesc ball_over_ground(const MaterialDesc& ground) {
    SceneDesc scene = empty_scene();
    scene.environment.enabled = true;
    scene.environment.color = Rgb(0.3f);
    scene.environment.visible_to_camera = false;
    LightDesc sun;
    sun.type = LightType::Directional;
    sun.intensity = 2.0f;
    const Vec3f back = normalize(Vec3f(-1.0f, 2.0f, 0.5f));
    const Vec3f right = normalize(cross(Vec3f(0.0f, 1.0f, 0.0f), back));
    const Vec3f up = cross(back, right);
    sun.to_world = Mat4f(right.x, right.y, right.z, 0, up.x, up.y, up.z, 0, back.x, back.y, back.z, 0, 0, 0, 0, 1);
    scene.lights.push_back(sun);
    add_object(scene, sphere({0.0f, 0.8f, 0.0f}, 0.5f, 12), add_material(scene, diffuse(Rgb(0.8f, 0.4f, 0.1f))));
    add_object(scene, quad_facing_up({0.0f, 0.0f, 0.0f}, 20.0f), add_material(scene, ground));
    look_at(scene, {0.0f, 3.0f, 3.0f}, {0.2f, 0.2f, 0.0f});
    return scene;
}

struct Pixels {
    std::vector<Rgb> colors;
    std::vector<double> alphas;
};

Pixels render_alone(const SceneDesc& scene, const std::string& name, std::uint32_t spp) {
    const World world = compile(scene);
    const auto integrator = make_integrator(name, {});
    const PixelFilter filter(FilterShape::Box);
    const auto scratch = integrator->make_scratch();
    const PixelRect all{0, 0, kCatcherSide, kCatcherSide};
    const TileJob job{all, all, kCatcherSide, kCatcherSide, 0, spp, 1, SampleSequence::Sobol, &filter};
    TileBuffer tile;
    tile.reset(job.rect);
    RenderCounters counters;
    integrator->render_tile(world, job, *scratch, tile, counters);
    Pixels pixels;
    for (std::size_t i = 0; i < all.area(); ++i) {
        const PixelSum& sum = tile.pixel(i);
        const double scale = 1.0 / static_cast<double>(sum.samples);
        pixels.colors.emplace_back(float(sum.r * scale), float(sum.g * scale), float(sum.b * scale));
        pixels.alphas.push_back(sum.alpha * scale);
    }
    return pixels;
}

MaterialDesc catcher() {
    MaterialDesc material = diffuse(Rgb(kGroundAlbedo));
    material.seen_as = SeenAs::Shadow;
    return material;
}

TEST(ShadowCatcher, CompositesOverAPlateToTheGroundThatItStandsFor) {
    const Pixels real = render_alone(ball_over_ground(diffuse(Rgb(kGroundAlbedo))), "direct", 256);
    const Pixels caught = render_alone(ball_over_ground(catcher()), "direct", 64);
    // The ground without the ball: a sky of 0.3 and a sun of 2 lux.
    const float cosine = 2.0f / std::sqrt(1.0f + 4.0f + 0.25f);
    const float plate = kGroundAlbedo * (0.3f + 2.0f * cosine * kInvPi);
    double difference = 0.0;
    for (std::size_t i = 0; i < real.colors.size(); ++i) {
        const float composite = caught.colors[i].g + (1.0f - float(caught.alphas[i])) * plate;
        EXPECT_NEAR(composite, real.colors[i].g, 0.05f * plate) << "pixel " << i;
        difference += double(composite - real.colors[i].g);
    }
    EXPECT_NEAR(difference / double(real.colors.size()), 0.0, 0.002 * double(plate));
}

TEST(ShadowCatcher, HasAlphaOfTheShadowAlone) {
    for (const char* const integrator : {"path", "naive", "bdpt", "vcm", "whitted"}) {
        const Pixels pixels = render_alone(ball_over_ground(catcher()), integrator, 32);
        double most = 0.0;
        double least = 1.0;
        std::size_t shadows = 0;
        for (std::size_t i = 0; i < pixels.colors.size(); ++i) {
            most = std::max(most, pixels.alphas[i]);
            least = std::min(least, pixels.alphas[i]);
            if (is_black(pixels.colors[i]) && pixels.alphas[i] > 0.5) ++shadows;
        }
        EXPECT_EQ(most, 1.0) << "on the ball";
        EXPECT_LT(least, 0.01) << "where nothing shadows";
        EXPECT_GT(shadows, 5u) << "in the shadow of the sun the catcher shows nothing of itself";
    }
}

// Nearly all samples that follow the radiance lie behind the catcher; a wall hides half of the sky above it.
TEST(ShadowCatcher, FindsTheSkyThatIsMuchDarkerThanWhatIsBehindIt) {
    ImageF sky(64, 32, 3);
    for (std::size_t i = 0; i < sky.pixels.size(); ++i) sky.pixels[i] = i < sky.pixels.size() / 2 ? 1.0f : 40.0f;
    const TemporaryFolder folder;
    const std::filesystem::path file = folder / "sky.exr";
    write_image(file, sky, {.depth = PixelDepth::Float});
    SceneDesc scene = empty_scene();
    scene.environment.enabled = true;
    scene.environment.image = file;
    scene.environment.visible_to_camera = false;
    add_object(scene, quad_facing_up({0.0f, 0.0f, 0.0f}, 20.0f), add_material(scene, catcher()));
    add_object(scene, quad({0.05f, 0.0f, 0.0f}, {0.0f, 0.0f, 90.0f}, {0.0f, 90.0f, 0.0f}),
               add_material(scene, diffuse(Rgb(0.5f))));
    look_at(scene, {-1.0f, 3.0f, 0.0f}, {0.0f, 0.0f, 0.0f});
    scene.cameras.at(0).yfov = 0.002f;
    const Pixels pixels = render_alone(scene, "path", 8);
    double sum = 0.0;
    for (const double alpha : pixels.alphas) sum += alpha;
    EXPECT_NEAR(sum / double(pixels.alphas.size()), 0.5, 0.01);
}

TEST(ShadowCatcher, IsRefusedWhereTheCameraIsInAMedium) {
    SceneDesc scene = ball_over_ground(catcher());
    MaterialDesc fog;
    fog.override_model = DielectricDesc{.ior = 1.01f, .volume = {.closed = true}};
    add_object(scene, sphere({0.0f, 0.0f, 0.0f}, 40.0f, 12), add_material(scene, fog));
    EXPECT_NO_THROW((void)compile(scene)) << "the body is empty";
    std::get<DielectricDesc>(scene.materials.back().override_model).volume.attenuation_distance = 10.0f;
    std::get<DielectricDesc>(scene.materials.back().override_model).volume.attenuation_color = Rgb(0.5f);
    EXPECT_THROW((void)compile(scene), SceneError);
}

TEST(ShadowCatcher, DarkensTheEnvironmentThatTheCameraSees) {
    SceneDesc scene = ball_over_ground(catcher());
    scene.environment.visible_to_camera = true;
    for (const char* const integrator : {"path", "bdpt", "whitted"}) {
        const Pixels pixels = render_alone(scene, integrator, 32);
        float brightest = 0.0f;
        float darkest = 1.0f;
        for (std::size_t i = 0; i < pixels.colors.size(); ++i) {
            EXPECT_EQ(pixels.alphas[i], 1.0) << integrator;
            if (pixels.colors[i].r == pixels.colors[i].b) brightest = std::max(brightest, pixels.colors[i].r);
            if (pixels.colors[i].r < 1.5f * pixels.colors[i].b) darkest = std::min(darkest, pixels.colors[i].r);
        }
        EXPECT_NEAR(brightest, 0.3f, 0.005f) << integrator << ": the sky, and no ground";
        EXPECT_LT(darkest, 0.2f) << integrator << ": the shadow";
    }
}

// A red lamp beside the ball, which it lights, cuts a hole into the image of a ground below a visible sky.
TEST(Holdout, CutsAHoleAndIsASurfaceToOtherRays) {
    const auto scene_with = [](SeenAs seen_as) {
        SceneDesc scene = ball_over_ground(diffuse(Rgb(kGroundAlbedo)));
        scene.environment.visible_to_camera = true;
        scene.lights.clear();
        MaterialDesc lamp = emissive(Rgb(30.0f, 0.0f, 0.0f));
        lamp.seen_as = seen_as;
        add_object(scene, sphere({0.9f, 0.4f, 0.9f}, 0.3f, 12), add_material(scene, lamp));
        return scene;
    };
    for (const char* const integrator : {"path", "direct", "naive", "bdpt", "vcm", "whitted"}) {
        const Pixels whole = render_alone(scene_with(SeenAs::Surface), integrator, 64);
        const Pixels holed = render_alone(scene_with(SeenAs::Hole), integrator, 64);
        std::size_t holes = 0;
        double before = 0.0;
        double after = 0.0;
        for (std::size_t i = 0; i < whole.colors.size(); ++i) {
            EXPECT_EQ(whole.alphas[i], 1.0);
            if (holed.alphas[i] == 0.0) {
                ++holes;
                EXPECT_TRUE(is_black(holed.colors[i])) << integrator;
                EXPECT_GT(whole.colors[i].r, 10.0f) << integrator << ": the lamp";
            }
            if (holed.alphas[i] == 1.0) {
                before += double(whole.colors[i].r);
                after += double(holed.colors[i].r);
            }
        }
        EXPECT_GT(holes, 10u) << integrator;
        EXPECT_NEAR(after / before, 1.0, 0.02) << integrator << ": the light of the lamp";
        EXPECT_GT(before, 100.0) << integrator;
    }
}

MaterialDesc clear_pane() {
    MaterialDesc material;
    material.metallic = 0.0f;
    material.roughness = 0.0f;
    material.transmission = 1.0f;
    return material;
}

// A pane stands between the camera and the ball.
SceneDesc ball_behind_pane(const MaterialDesc& ground) {
    SceneDesc scene = ball_over_ground(ground);
    add_object(scene, quad({0.0f, 1.6f, 1.6f}, {4.0f, 0.0f, 0.0f}, {0.0f, 3.0f, 0.0f}),
               add_material(scene, clear_pane()));
    return scene;
}

// The camera looks at the ball through a pane; a hole takes the place of all but the ball.
TEST(Holdout, IsSeenThroughPanes) {
    MaterialDesc ground = diffuse(Rgb(kGroundAlbedo));
    ground.seen_as = SeenAs::Hole;
    for (const char* const integrator : {"path", "bdpt", "vcm", "whitted"}) {
        const Pixels pixels = render_alone(ball_behind_pane(ground), integrator, 32);
        EXPECT_LT(*std::ranges::min_element(pixels.alphas), 0.3) << integrator << ": what the pane reflects";
        EXPECT_EQ(*std::ranges::max_element(pixels.alphas), 1.0) << integrator << ": the ball";
    }
}

TEST(ShadowCatcher, ShowsNothingOfItselfThroughPanes) {
    for (const char* const integrator : {"path", "bdpt", "vcm", "whitted"}) {
        const Pixels pixels = render_alone(ball_behind_pane(catcher()), integrator, 32);
        const double least = *std::ranges::min_element(pixels.alphas);
        EXPECT_LT(least, 0.3) << integrator << ": what the pane reflects, and the light that it takes from the ground";
        EXPECT_EQ(*std::ranges::max_element(pixels.alphas), 1.0) << integrator << ": the ball";
    }
}

/// A slab of air that takes half of what passes it straight, between a camera that looks straight down and `ground`,
/// under a sun that shines straight down.
SceneDesc ground_below_tinted_air(const MaterialDesc& ground) {
    SceneDesc scene = empty_scene();
    MaterialDesc air = clear_pane();
    air.ior = 1.0f;
    air.volume = {.closed = true, .attenuation_color = Rgb(0.5f), .attenuation_distance = 1.0f};
    const Mat4f slab = scaling({8.0f, 0.5f, 8.0f}) * translation({0.0f, 1.0f, 0.0f});
    add_object(scene, cube(), add_material(scene, air), slab);
    add_object(scene, quad_facing_up({0.0f, 0.0f, 0.0f}, 5.0f), add_material(scene, ground));
    LightDesc sun;
    sun.type = LightType::Directional;
    sun.intensity = 2.0f;
    sun.to_world = Mat4f(1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1);
    scene.lights.push_back(sun);
    scene.cameras.at(0).to_world = Mat4f(1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 4, 0, 1);
    scene.cameras.at(0).yfov = 0.05f;
    return scene;
}

double mean_alpha(const Pixels& pixels) {
    return std::accumulate(pixels.alphas.begin(), pixels.alphas.end(), 0.0) / double(pixels.alphas.size());
}

// A quarter of the sun's light on the ground reaches the eye: the air passes half of it on each of two ways.
// Roulette makes single samples vary, so the bound is five standard deviations.
TEST(ShadowCatcher, IsInTheShadowOfAirAndBehindIt) {
    MaterialDesc hole = diffuse(Rgb(kGroundAlbedo));
    hole.seen_as = SeenAs::Hole;
    for (const char* const integrator : {"path", "bdpt", "vcm", "whitted"}) {
        EXPECT_NEAR(mean_alpha(render_alone(ground_below_tinted_air(catcher()), integrator, 16)), 0.75, 5e-3)
            << integrator;
        EXPECT_NEAR(mean_alpha(render_alone(ground_below_tinted_air(hole), integrator, 16)), 0.5, 5e-3) << integrator;
    }
}

// Without a ground, air and panes dim the background plate as they dim light.
TEST(Alpha, IsWhatClearSurfacesTakeOfTheBackground) {
    SceneDesc scene = ground_below_tinted_air(diffuse(Rgb(kGroundAlbedo)));
    scene.instances.pop_back();
    MaterialDesc pane = clear_pane();
    pane.base_color = Rgb(0.25f);
    pane.specular = 0.0f;
    add_object(scene, quad_facing_up({0.0f, 0.1f, 0.0f}, 5.0f), add_material(scene, pane));
    for (const char* const integrator : {"path", "bdpt", "vcm", "whitted"})
        EXPECT_NEAR(mean_alpha(render_alone(scene, integrator, 64)), 1.0 - 0.5 * 0.25, 5e-3) << integrator;
}

// Glass and a mirror stand on the catcher, of which they see the surface.
SceneDesc things_on_catcher() {
    SceneDesc scene = ball_behind_pane(catcher());
    scene.lights.clear();
    add_object(scene, quad({-0.5f, 3.0f, 0.0f}, {0.5f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.5f}),
               add_material(scene, emissive(Rgb(4.0f))));
    MaterialDesc glass;
    glass.override_model = DielectricDesc{};
    MaterialDesc mirror;
    mirror.override_model = ConductorDesc{.metal = "Ag", .roughness = 0.2f};
    add_object(scene, sphere({-1.0f, 0.41f, 0.3f}, 0.4f, 12), add_material(scene, glass));
    add_object(scene, sphere({1.1f, 0.41f, 0.0f}, 0.4f, 12), add_material(scene, mirror));
    return scene;
}

class ShadowCatcherOf : public testing::TestWithParam<const char*> {};

TEST_P(ShadowCatcherOf, LightsObjectsAsInPathTracing) {
    expect_image_of_path(compile(things_on_catcher()), GetParam(), 12, 900);
}

INSTANTIATE_TEST_SUITE_P(Integrators, ShadowCatcherOf, testing::Values("naive", "bdpt", "vcm"),
                         [](const auto& run) { return std::string(run.param); });

TEST(ShadowCatcher, IsAnOrdinarySurfaceToTheRestOfTheScene) {
    SceneDesc scene = ball_over_ground(catcher());
    const Pixels lit = render_alone(scene, "path", 32);
    scene.materials.at(1).override_model = DiffuseDesc{.albedo = Rgb(0.0f)};
    const Pixels dark = render_alone(scene, "path", 32);
    double more = 0.0;
    for (std::size_t i = 0; i < lit.colors.size(); ++i) more += double(lit.colors[i].r - dark.colors[i].r);
    EXPECT_GT(more, 1.0) << "the ground lights the ball from below";
}

}  // namespace
}  // namespace etendue::test
