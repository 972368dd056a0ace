// What merging finds: light between two smooth refractions, which no connection can.
#include "integrator/agreement_cases.h"
#include "integrator/agreement_render.h"
#include "integrator/agreement_room.h"
#include "integrator/bdpt/bdpt_integrator.h"
#include "integrator/bdpt/render_bdpt.h"
#include "integrator/path/path_integrator.h"
#include "support/chi2.h"
#include "support/random.h"
#include "wave/aov/layered_render.h"
#include "world/test_scene.h"

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr int kPlateSize = 32;
constexpr float kPlateThickness = 0.02f;
constexpr float kIor = 1.5f;

/// A body between two heights.
void add_slab(SceneDesc& scene, float bottom, float top, const MaterialDesc& filling) {
    const Handle<MaterialDesc> material = add_material(scene, filling);
    const float middle = 0.5f * (bottom + top);
    const Vec3f up{0, 0.5f * (top - bottom), 0};
    std::vector<PrimitiveDesc> faces = {
        quad({0, top, 0}, {0, 0, 2}, {2, 0, 0}), quad({0, bottom, 0}, {2, 0, 0}, {0, 0, 2}),
        quad({2, middle, 0}, up, {0, 0, 2}),     quad({-2, middle, 0}, {0, 0, 2}, up),
        quad({0, middle, 2}, {2, 0, 0}, up),     quad({0, middle, -2}, up, {2, 0, 0})};
    for (PrimitiveDesc& face : faces) face.material = material;
    place(scene, add_mesh(scene, faces), Mat4f());
}

/// Has the camera look straight down from `height`.
void look_down(SceneDesc& scene, float height, float camera_width) {
    CameraDesc& camera = scene.cameras[0];
    camera.type = CameraType::Orthographic;
    camera.ymag = 0.5f * camera_width;
    camera.to_world = looking_down(0.5f * std::numbers::pi_v<float>) * translation({0, height, 0});
    scene.settings.film.width = scene.settings.film.height = kPlateSize;
}

double mean_of_render(const World& world, const Integrator& integrator, std::uint32_t spp, int size = kPlateSize) {
    const ThreadPool threads;
    const std::atomic<bool> stop{false};
    return mean_of(render(world, integrator, whole_image(size, size, spp, 3), threads, stop, {}).film.resolve());
}

/// Adds a plate of glass above the ground, and above that a spot and a camera that look straight down.
void add_plate(SceneDesc& scene, float camera_width) {
    add_slab(scene, 1.0f - 0.5f * kPlateThickness, 1.0f + 0.5f * kPlateThickness, glass(0.0f));
    LightDesc spot =
        light(LightType::Spot, 10.0f, looking_down(0.5f * std::numbers::pi_v<float>) * translation({0, 2, 0}));
    spot.inner_cone_angle = 0.15f;
    spot.outer_cone_angle = 0.16f;
    scene.lights.push_back(spot);
    look_down(scene, 3.0f, camera_width);
}

/// A grey floor under the plate.
SceneDesc plate_over_floor(float camera_width) {
    SceneDesc scene = empty_scene();
    add_object(scene, quad({0, 0, 0}, {0, 0, 4}, {4, 0, 0}), add_material(scene, diffuse(Rgb(0.5f))));
    add_plate(scene, camera_width);
    return scene;
}

/// What the plate's floor sends to the eye.
double light_through_plate() {
    const double fresnel = std::pow((static_cast<double>(kIor) - 1.0) / (static_cast<double>(kIor) + 1.0), 2.0);
    const double passes = std::pow(1.0 - fresnel, 2.0);
    const double distance = 2.0 - static_cast<double>(kPlateThickness) * (1.0 - 1.0 / static_cast<double>(kIor));
    return 10.0 / (distance * distance) * passes * passes * 0.5 / std::numbers::pi;
}

// No other path of six edges reaches the eye: light goes through the plate, is scattered by the floor, and goes through
// the plate again. Both ways a share (1 - F)² of it passes, and the floor sees the spot kPlateThickness (1 - 1 / n)
// nearer.
TEST(Merging, FindsWhatASpotSendsThroughAPlateTwice) {
    const World world = compile(plate_over_floor(0.2f));
    const double expected = light_through_plate();
    const auto mean = [&](MergeAt merge) {
        return mean_of_render(world, BdptIntegrator({.lengths = {.max_depth = 6}, .merging = {.at = merge}}), 32);
    };
    // The eye sees a part in which irradiance differs by 1%; counts of some ten thousand photons vary by as much.
    EXPECT_NEAR(mean(MergeAt::SeenByDeltas), expected, 0.02 * expected);
    EXPECT_NEAR(mean(MergeAt::Everywhere), expected, 0.02 * expected);
    EXPECT_EQ(mean(MergeAt::Nothing), 0.0);
}

// Kernels grow with the distance, so that on a slope a photon has another radius than the vertex that it merges with.
TEST(Merging, WeightsEverywhereSumToOneOnASlope) {
    SceneDesc scene = empty_scene();
    scene.cameras[0].yfov = 0.5f;
    const Vec3f up_the_slope = Vec3f(0.0f, 0.5f, -std::sqrt(0.75f));
    add_object(scene, quad({0.0f, 0.5f, -3.87f}, {2, 0, 0}, up_the_slope * 3.0f),
               add_material(scene, diffuse(Rgb(0.5f))));
    scene.lights.push_back(light(LightType::Directional, 10.0f, Mat4f()));
    const IntegratorSettings settings{.lengths = {.max_depth = 2},
                                      .merging = {.at = MergeAt::Everywhere, .radius = 100.0}};
    const double expected = 10.0 * 0.5 * 0.5 / std::numbers::pi;
    // By its own radius on both sides, a merge would count as 0.9 of itself here.
    EXPECT_NEAR(mean_of_render(compile(std::move(scene)), BdptIntegrator(settings), 64, 64), expected,
                0.015 * expected);
}

IntegratorSettings merges_alone(bool weighted) {
    return {.lengths = {.max_depth = 6}, .strategy = kMerges, .weighted = weighted};
}

/// Returns a grey material of which the share `opacity` is there.
MaterialDesc veil(float albedo, float opacity) {
    MaterialDesc material = diffuse(Rgb(albedo));
    material.alpha_mode = AlphaMode::Blend;
    material.base_alpha = opacity;
    return material;
}

// Subpaths from both ends stop there by chance; the light of the place counts its opacity once.
TEST(Merging, CountsTheOpacityOfASurfaceOnce) {
    SceneDesc scene = empty_scene();
    add_object(scene, quad({0, 0, 0}, {0, 0, 4}, {4, 0, 0}), add_material(scene, veil(0.5f, 0.3f)));
    add_plate(scene, 0.2f);
    const World world = compile(std::move(scene));
    const double expected = 0.3 * light_through_plate();
    for (const MergeAt at : {MergeAt::SeenByDeltas, MergeAt::Everywhere}) {
        IntegratorSettings settings = merges_alone(true);
        settings.merging.at = at;
        EXPECT_NEAR(mean_of_render(world, BdptIntegrator(settings), 48), expected, 0.03 * expected);
    }
}

// Light passes a black veil just above the floor twice, and none that this stops arrives there.
TEST(Merging, KeepsTheLightOfAVeilFromWhatLiesBehind) {
    SceneDesc scene = plate_over_floor(0.2f);
    add_object(scene, quad({0, 1e-4f, 0}, {0, 0, 4}, {4, 0, 0}), add_material(scene, veil(0.0f, 0.5f)));
    const double expected = 0.25 * light_through_plate();
    EXPECT_NEAR(mean_of_render(compile(std::move(scene)), BdptIntegrator(merges_alone(true)), 48), expected,
                0.03 * expected);
}

TEST(Merging, LosesNothingWhereWindingsDiffer) {
    SceneDesc scene = empty_scene();
    constexpr int kCells = 40;
    constexpr float kHalf = 5e-3f;
    PrimitiveDesc floor;
    Random random(3);
    for (int z = 0; z < kCells; ++z)
        for (int x = 0; x < kCells; ++x) {
            const auto place = [](int cell) { return static_cast<float>(2 * cell + 1 - kCells) * kHalf; };
            const Vec3f along_x{kHalf, 0, 0};
            const Vec3f along_z{0, 0, kHalf};
            const bool turned = random.next() < 0.5f;
            const PrimitiveDesc cell =
                quad({place(x), 0, place(z)}, turned ? along_x : along_z, turned ? along_z : along_x);
            const auto first = static_cast<std::uint32_t>(floor.positions.size());
            floor.positions.insert(floor.positions.end(), cell.positions.begin(), cell.positions.end());
            for (const auto& [a, b, c] : cell.triangles) floor.triangles.push_back({first + a, first + b, first + c});
        }
    MaterialDesc grey = diffuse(Rgb(0.5f));
    grey.double_sided = true;
    add_object(scene, std::move(floor), add_material(scene, grey));
    add_plate(scene, 0.2f);
    const double expected = light_through_plate();
    EXPECT_NEAR(mean_of_render(compile(std::move(scene)), BdptIntegrator(merges_alone(true)), 32), expected,
                0.02 * expected);
}

// Air that covers all has the plate bend no light, but no connection passes its boundaries.
TEST(Merging, FindsWhatPassesHiddenBoundariesTwice) {
    SceneDesc scene = plate_over_floor(0.2f);
    MaterialDesc air;
    DielectricDesc desc{.ior = 1.0f, .roughness = 0.0f};
    desc.volume.priority = 1;
    air.override_model = desc;
    add_object(scene, sphere({0, 1, 0}, 9.0f, 4), add_material(scene, air));
    const World world = compile(std::move(scene));
    const double expected = 10.0 / 4.0 * 0.5 / std::numbers::pi;
    for (const MergeAt at : {MergeAt::SeenByDeltas, MergeAt::Everywhere}) {
        IntegratorSettings settings{.lengths = {.max_depth = 2}};
        settings.merging.at = at;
        EXPECT_NEAR(mean_of_render(world, BdptIntegrator(settings), 32), expected, 0.02 * expected);
    }
    EXPECT_EQ(
        mean_of_render(world, BdptIntegrator({.lengths = {.max_depth = 2}, .merging = {.at = MergeAt::Nothing}}), 4),
        0.0);
}

// The light that both kinds of merges can find is the plate's: seen by two refractions, lit by two.
TEST(Merging, AloneFindsWhatNothingElseDoes) {
    const World world = compile(plate_over_floor(0.2f));
    const double expected = light_through_plate();
    for (const bool weighted : {true, false})
        EXPECT_NEAR(mean_of_render(world, BdptIntegrator(merges_alone(weighted)), 32), expected, 0.02 * expected);
}

// Two slopes under a plate light each other. Connections of theirs come near to each other in the fold, with no other
// strategy to tame them, so that merges are to bring about half of that light.
TEST(Merging, TakesTheLightOfFoldsUnderGlass) {
    SceneDesc scene = empty_scene();
    const Handle<MaterialDesc> grey = add_material(scene, diffuse(Rgb(0.5f)));
    add_object(scene, quad({-0.2f, 0.2f, 0}, {0, 0, 2}, {0.2f, -0.2f, 0}), grey);
    add_object(scene, quad({0.2f, 0.2f, 0}, {0, 0, 2}, {0.2f, 0.2f, 0}), grey);
    add_plate(scene, 0.2f);
    const World world = compile(std::move(scene));
    const auto mean = [&](IntegratorSettings settings) {
        settings.lengths = {.max_depth = 7, .min_depth = 7};
        return mean_of_render(world, BdptIntegrator(settings), 64);
    };
    const double light = mean({});
    EXPECT_NEAR(light, mean({.merging = {.at = MergeAt::Nothing}}), 0.03 * light);
    EXPECT_GT(mean({.strategy = kMerges}), 0.35 * light);
}

// A grey box, lit by a lamp that the camera does not see: one way to each path, wherever subpaths could merge.
TEST(Merging, AloneAndWithoutWeightsIsPhotonMapping) {
    SceneDesc scene = empty_scene();
    const Handle<MaterialDesc> grey = add_material(scene, diffuse(Rgb(0.6f)));
    add_object(scene, quad({0, 0, 0}, {0, 0, 2}, {2, 0, 0}), grey);
    add_object(scene, quad({0, 2, -2}, {2, 0, 0}, {0, 2, 0}), grey);
    add_object(scene, quad({0, 2, 2}, {0, 2, 0}, {2, 0, 0}), grey);
    scene.lights.push_back(light(LightType::Point, 10.0f, translation({0.5f, 1.5f, 0.25f})));
    look_down(scene, 3.0f, 2.0f);
    const World world = compile(std::move(scene));
    const double expected = mean_of_render(world, PathIntegrator({.lengths = {.max_depth = 6}}), 64);
    const auto mean = [&](IntegratorSettings settings) {
        settings.merging.at = MergeAt::Everywhere;
        return mean_of_render(world, BdptIntegrator(settings), 256);
    };
    // Some fifty thousand photons lie in view, and light of one lies in a few pixels of each sample: within 0.5%.
    EXPECT_NEAR(mean(merges_alone(false)), expected, 0.02 * expected);
    EXPECT_LT(mean(merges_alone(true)), 0.5 * expected);
}

TEST(Merging, BoundsThePhotonsOfLargeImages) {
    constexpr int kSize = 1100;
    const PixelRect window{0, 0, kSize, kSize};
    EXPECT_EQ(photon_step(window), 2u);
    EXPECT_EQ(photon_paths(window), window.area() / 2);
    EXPECT_EQ(photon_paths({0, 0, kPlateSize, kPlateSize}), 1024u);
    std::size_t pixels = 0;
    for (const PixelRect& tile : {PixelRect{0, 0, 333, kSize}, PixelRect{333, 0, kSize, kSize}})
        pixels += photon_pixels(window, tile, 0).size();
    EXPECT_EQ(pixels, photon_paths(window));
    const World world = compile(plate_over_floor(0.2f));
    const BdptIntegrator integrator({.lengths = {.max_depth = 6, .min_depth = 6}, .merging = {.radius = 20.0}});
    RenderOptions options = whole_image(kSize, kSize, 1, 3);
    options.window = {kSize / 2 - 32, kSize / 2 - 32, kSize / 2 + 32, kSize / 2 + 32};
    options.splat_window = window;
    const std::atomic<bool> stop{false};
    const Film part = render(world, integrator, options, ThreadPool(), stop, {}).film;
    const double expected = light_through_plate();
    EXPECT_NEAR(mean_of(part.resolve()), expected, 0.05 * expected);
}

constexpr float kWater = 1.33f;
constexpr float kDepth = 0.5f;
constexpr float kSeen = 1.2f;

/// A grey floor under smooth water, below a lamp at `height` of 10 W/sr: a point, or a small square.
World pool(bool is_point, float height) {
    SceneDesc scene = empty_scene();
    add_object(scene, quad({0, 0, 0}, {0, 0, 1.9f}, {1.9f, 0, 0}), add_material(scene, diffuse(Rgb(0.5f))));
    MaterialDesc water;
    water.override_model = DielectricDesc{.ior = kWater, .roughness = 0.0f};
    add_slab(scene, -0.1f, kDepth, water);
    if (is_point) {
        scene.lights.push_back(light(LightType::Point, 10.0f, translation({0, height, 0})));
    } else {
        constexpr float kHalf = 5e-3f;
        add_object(scene, quad({0, height, 0}, {kHalf, 0, 0}, {0, 0, kHalf}),
                   add_material(scene, emissive(Rgb(10.0f / (4.0f * kHalf * kHalf)))));
    }
    look_down(scene, height - 0.5f, kSeen);
    return compile(std::move(scene));
}

/// Share of light that water takes in at `theta`.
double taken_in(double theta) {
    const auto n = static_cast<double>(kWater);
    const double below = std::asin(std::sin(theta) / n);
    const double s = (std::cos(theta) - n * std::cos(below)) / (std::cos(theta) + n * std::cos(below));
    const double p = (n * std::cos(theta) - std::cos(below)) / (n * std::cos(theta) + std::cos(below));
    return 1.0 - 0.5 * (s * s + p * p);
}

/// Light from the floor of `pool`, as it is seen from above, in the mean over a square of this width: what leaves the
/// lamp at an angle arrives on a ring, and what comes out of the water has lost n² of its radiance.
double light_of_pool(bool is_point, double height, double width) {
    const auto n = static_cast<double>(kWater);
    const auto ring = [&](double theta) {
        return (height - static_cast<double>(kDepth)) * std::tan(theta) +
               static_cast<double>(kDepth) * std::tan(std::asin(std::sin(theta) / n));
    };
    const auto irradiance = [&](double radius) {
        double low = 0.0;
        double high = 1.2;
        while (high - low > 1e-9) (ring(0.5 * (low + high)) < radius ? low : high) = 0.5 * (low + high);
        constexpr double kStep = 1e-5;
        const double wider = (ring(low + kStep) - ring(low)) / kStep;
        return 10.0 * (is_point ? 1.0 : std::cos(low)) * taken_in(low) * std::sin(low) / (radius * wider);
    };
    constexpr int kCells = 32;
    double sum = 0.0;
    for (int y = 0; y < kCells; ++y)
        for (int x = 0; x < kCells; ++x)
            sum += irradiance(width * std::hypot((x + 0.5) / kCells - 0.5, (y + 0.5) / kCells - 0.5));
    return sum / (kCells * kCells) * taken_in(0.0) * 0.5 / std::numbers::pi / (n * n);
}

TEST(Merging, ShowsTheFloorOfAPoolUnderAPointAsUnderASmallLamp) {
    constexpr float kHeight = 2.0f;
    const BdptIntegrator merging({.lengths = {.max_depth = 4, .min_depth = 4}});
    for (const bool is_point : {true, false}) {
        const double expected = light_of_pool(is_point, static_cast<double>(kHeight), static_cast<double>(kSeen));
        EXPECT_NEAR(mean_of_render(pool(is_point, kHeight), merging, 160), expected, 0.03 * expected)
            << (is_point ? "point" : "lamp");
    }
}

/// A quad within a ball of glass below a large lamp, in a closed room.
World quad_in_ball() {
    SceneDesc scene = empty_scene();
    add_object(scene, sphere({0, 0, 0}, 0.5f, 24), add_material(scene, glass(0.0f)));
    add_object(scene, quad({0, 0, 0}, {0, 0, 0.25f}, {0.25f, 0, 0}), add_material(scene, diffuse(Rgb(0.8f))));
    add_object(scene, quad({0, -1, 0}, {0, 0, 2}, {2, 0, 0}), add_material(scene, diffuse(Rgb(0.5f))));
    add_object(scene, quad({0, 1.5f, 0}, {2, 0, 0}, {0, 0, 2}), add_material(scene, emissive(Rgb(1.0f))));
    look_down(scene, 1.0f, 0.3f);
    return compile(std::move(scene));
}

TEST(Merging, KeepsTheEnergyOfLightThatEyePathsMeetByChance) {
    const World world = quad_in_ball();
    const PathLengths lengths{.max_depth = 8, .min_depth = 4};
    const double expected = mean_of_render(world, *make_integrator("naive", {.lengths = lengths}), 1024);
    for (const Heuristic heuristic : {Heuristic::Balance, Heuristic::Power}) {
        IntegratorSettings settings{.lengths = lengths, .heuristic = heuristic, .merging = {.radius = 8.0}};
        EXPECT_NEAR(mean_of_render(world, BdptIntegrator(settings), 384), expected, 0.01 * expected);
        settings.strategy = kMerges;
        EXPECT_GT(mean_of_render(world, BdptIntegrator(settings), 8), 0.3 * expected);
    }
}

TEST(Merging, IsInTheLayersOfItsPaths) {
    AgreementCase plate{.name = "Plate", .make = [](SceneDesc&) {}, .window = {0, 0, kPlateSize, kPlateSize}, .spp = 4};
    const World world = compile(plate_over_floor(0.2f));
    const BdptIntegrator merging({.lengths = {.max_depth = 6}});
    RenderOptions options = whole_image(kPlateSize, kPlateSize, 4, 3);
    options.aovs = std::make_shared<AovSet>(expression_layers(plate, {"C S+ D S+ L", "C D S+ L", "C <TS>+ D .* L"}));
    const std::atomic<bool> stop{false};
    const Film film = render(world, merging, options, ThreadPool(), stop, {}).film;
    const std::vector<float> image = film.resolve();
    const std::vector<float> caustic = film.resolve_light(0);
    const std::vector<float> transmitted = film.resolve_light(2);
    EXPECT_GT(mean_of(image), 0.1);
    for (std::size_t i = 0; i < caustic.size(); ++i) {
        EXPECT_FLOAT_EQ(caustic[i], image[i / 3 * 4 + i % 3]);
        EXPECT_FLOAT_EQ(transmitted[i], image[i / 3 * 4 + i % 3]);
    }
    for (const float value : film.resolve_light(1)) EXPECT_EQ(value, 0.0f);
}

/// A room, where subpaths merge, and the heuristic.
using MergedRoom = std::tuple<const char*, MergeAt>;

std::string name_of_merged_room(const testing::TestParamInfo<MergedRoom>& info) {
    const auto& [name, merge] = info.param;
    return name + std::string(merge == MergeAt::Everywhere ? "Everywhere" : "SeenByDeltas");
}

class MergingAgreement : public testing::TestWithParam<MergedRoom> {};

// With so small a radius its bias is below the noise.
TEST_P(MergingAgreement, MakesTheSameImage) {
    constexpr int kRooms = 2;  // instances
    const auto& [name, merge] = GetParam();
    const AgreementCase& room = agreement_case(name);
    const World world = agreement_world(room);
    const ThreadPool threads;
    const BdptIntegrator merging({.lengths = room.lengths, .merging = {.at = merge, .radius = 0.2, .alpha = 1.0}});
    const BlockAgreement result =
        test_agreement(estimate(world, "path", room, {.first_seed = 700}, threads),
                       estimate(world, merging, room, {.first_seed = 800}, threads, room.window),
                       {.block_size = kAgreementBlock, .significance = sidak_level(kFamilyLevel, kRooms)});
    EXPECT_TRUE(result.agree()) << result.str();
}

INSTANTIATE_TEST_SUITE_P(Rooms, MergingAgreement,
                         testing::Values(MergedRoom{"SmoothGlass", MergeAt::SeenByDeltas},
                                         MergedRoom{"LampPlastic", MergeAt::Everywhere}),
                         name_of_merged_room);

}  // namespace

}  // namespace etendue::test
