// Next-event splitting: more light samples where the eye looks change the noise of an image and nothing else.
//
// All comparisons of rooms together fail with probability 0.01 if everything is right (Sidak's correction); seeds are
// fixed.
#include "integrator/agreement_render.h"
#include "integrator/closed_form.h"
#include "integrator/path/path_integrator.h"
#include "integrator/render_tile.h"
#include "support/chi2.h"
#include "wave/aov/layered_render.h"
#include "world/test_scene.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

PathIntegrator path_with(std::uint32_t light_samples, const PathLengths& lengths = {}) {
    return PathIntegrator({.lengths = lengths, .light_samples = light_samples});
}

/// With the kinds of light, of surface, among them deltas beside lobes, and of vertex that are sampled in ways of their
/// own.
constexpr std::array kRooms{"LampDiffuse",  "LampPlastic", "LampConductor",        "LampLayers",
                            "TwoSidedLamp", "SmoothCoat",  "PointPlastic",         "SpotConductor",
                            "SheetAndLeaf", "LampPrism",   "VeilMirroredThinLens", "SecondBounceOnly",
                            "Mirror",       "LampWax",     "LampInFogOneSurface"};

/// One light sample against three, with half of the room's samples.
BlockAgreement compare(const World& world, AgreementCase room) {
    constexpr int kComparisons = static_cast<int>(kRooms.size()) + 1;  // with that of an image of the environment
    room.spp /= 2;
    const ThreadPool threads;
    return test_agreement(estimate(world, path_with(1, room.lengths), room, {.first_seed = 100}, threads, room.window),
                          estimate(world, path_with(3, room.lengths), room, {.first_seed = 200}, threads, room.window),
                          {.block_size = kAgreementBlock, .significance = sidak_level(kFamilyLevel, kComparisons)});
}

class LightSamplesAgree : public testing::TestWithParam<const char*> {};

TEST_P(LightSamplesAgree, MakeTheSameImage) {
    const AgreementCase& room = agreement_case(GetParam());
    const BlockAgreement result = compare(agreement_world(room), room);
    EXPECT_TRUE(result.agree()) << result.str();
}

// One of a single colour is not sampled.
TEST(LightSamples, OfAnEnvironmentMakeTheSameImage) {
    const AgreementCase& room = agreement_case("Environment");
    const CosineImage image(Vec3f(0.6f, 0.8f, 0.0f));
    SceneDesc scene = agreement_scene(room);
    scene.environment.image = image.path();
    const World world = compile(std::move(scene));
    ASSERT_TRUE(world.traits().has_sampled_lights);
    const BlockAgreement result = compare(world, room);
    EXPECT_TRUE(result.agree()) << result.str();
}

// Paths whose words are followed have shadow rays of their own.
TEST_P(LightSamplesAgree, MakeTheSameImageWithLayers) {
    AgreementCase room = agreement_case(GetParam());
    room.spp = 4;
    const World world = agreement_world(room);
    const PathIntegrator split = path_with(3, room.lengths);
    const auto aovs = std::make_shared<AovSet>(expression_layers(room, {"C .* L"}));
    const Film with = render_layers(world, split, room, aovs, 3).film;
    const std::vector<float> image = with.resolve();
    EXPECT_EQ(image, render_layers(world, split, room, nullptr, 3).film.resolve());
    const std::vector<float> layer = with.resolve_light(0);
    double sum = 0.0;
    double layer_sum = 0.0;
    for (std::size_t i = 0; i < layer.size(); ++i) {
        sum += static_cast<double>(image[i / 3 * 4 + i % 3]);
        layer_sum += static_cast<double>(layer[i]);
    }
    EXPECT_NEAR(layer_sum, sum, 1e-5 * sum);
}

INSTANTIATE_TEST_SUITE_P(Rooms, LightSamplesAgree, testing::ValuesIn(kRooms),
                         [](const auto& each) { return std::string(each.param); });

/// A wall under a large lamp, seen directly or in a mirror.
SceneDesc wall_under_a_lamp(bool in_mirror) {
    SceneDesc scene = empty_scene();
    const auto wall = add_material(scene, diffuse(Rgb(0.7f)));
    const float away = in_mirror ? 3.0f : -3.0f;
    add_object(scene, quad({0, 0, away}, {4, 0, 0}, {0, in_mirror ? -4.0f : 4.0f, 0}), wall);
    add_object(scene, quad({0, 5, away * 0.3f}, {2, 0, 0}, {0, 0, 2}), add_material(scene, emissive(Rgb(1.0f))));
    if (in_mirror) {
        MaterialDesc mirror;
        mirror.override_model = ConductorDesc{.metal = "Ag", .roughness = 0.0f};
        add_object(scene, quad({0, 0, -3}, {4, 0, 0}, {0, 4, 0}), add_material(scene, mirror));
    }
    return scene;
}

double squared_error(const World& world, std::uint32_t light_samples, const PathLengths& lengths) {
    constexpr PixelRect kWindow{0, 0, 24, 24};
    const auto pixels = [&](std::uint32_t samples, std::uint32_t spp) {
        return render_pixels(world, path_with(samples, lengths), kWindow, 24, 24, spp);
    };
    const std::vector<Rgb> one = pixels(light_samples, 1);
    const std::vector<Rgb> reference = pixels(1, 256);
    double sum = 0.0;
    for (std::size_t i = 0; i < one.size(); ++i) {
        const auto difference = static_cast<double>(one[i].g - reference[i].g);
        sum += difference * difference;
    }
    return sum;
}

// Well spread over the lamp, four samples have less than a quarter of the variance of one; the sums over 576 pixels are
// good to a tenth.
TEST(LightSamples, TakeNoiseOutOfSoftLight) {
    for (const bool in_mirror : {false, true}) {
        const World world = compile(wall_under_a_lamp(in_mirror));
        const int edges = in_mirror ? 3 : 2;
        const PathLengths lengths{.max_depth = edges, .min_depth = edges};
        const double one = squared_error(world, 1, lengths);
        EXPECT_GT(one, 0.0);
        EXPECT_LT(squared_error(world, 4, lengths), 0.3 * one) << (in_mirror ? "in a mirror" : "directly");
    }
}

// Of what the eye does not see directly each vertex samples one light.
TEST(LightSamples, SplitFirstVerticesOnly) {
    const AgreementCase& room = agreement_case("LampDiffuse");
    const World world = agreement_world(room);
    const auto shadow_rays = [&](std::uint32_t samples, int max_depth) {
        return render_tile(world, path_with(samples, {.max_depth = max_depth}), 64).counters.rays[RayKind::Shadow];
    };
    const auto first = static_cast<double>(shadow_rays(1, 2));
    const auto later = static_cast<double>(shadow_rays(1, 3)) - first;
    ASSERT_GT(first, 0.0);
    ASSERT_GT(later, 0.1 * first);
    EXPECT_NEAR(static_cast<double>(shadow_rays(4, 2)), 4.0 * first, 0.05 * first);
    EXPECT_NEAR(static_cast<double>(shadow_rays(4, 3)), 4.0 * first + later, 0.05 * first);
}

TEST(LightSamples, OfALampWithoutSizeAreAllTheSame) {
    SceneDesc scene = empty_scene();
    add_object(scene, quad({0, 0, -3}, {4, 0, 0}, {0, 4, 0}), add_material(scene, diffuse(Rgb(0.7f))));
    LightDesc light;
    light.intensity = 5.0f;
    scene.lights.push_back(light);
    const World world = compile(std::move(scene));
    const Rgb one = render_tile(world, path_with(1), 16).mean;
    const Rgb seven = render_tile(world, path_with(7), 16).mean;
    EXPECT_GT(one.g, 0.0f);
    EXPECT_NEAR(seven.g, one.g, 1e-5f * one.g);
}

// A sheet that lets half of the light through, between the wall and a lamp without size.
TEST(LightSamples, MeetTransparencyEachForItself) {
    SceneDesc scene = empty_scene();
    add_object(scene, quad({0, 0, -3}, {4, 0, 0}, {0, 4, 0}), add_material(scene, diffuse(Rgb(0.7f))));
    MaterialDesc half = diffuse(Rgb(0.0f));
    half.alpha_mode = AlphaMode::Blend;
    half.base_alpha = 0.5f;
    add_object(scene, quad({0, 4, -1}, {9, 0, 0}, {0, 0, 9}), add_material(scene, half));
    LightDesc light;
    light.intensity = 50.0f;
    light.to_world = translation({0, 8, 0});
    scene.lights.push_back(light);
    const World world = compile(std::move(scene));
    const PathLengths lengths{.max_depth = 2, .min_depth = 2};
    const double one = squared_error(world, 1, lengths);
    EXPECT_GT(one, 0.0);
    EXPECT_LT(squared_error(world, 4, lengths), 0.4 * one);
}

std::vector<Rgb> pixels_in_jobs(const World& world, const AovSet* aovs, std::uint32_t job_samples) {
    constexpr std::uint32_t kSamples = 32;
    const PathIntegrator split = path_with(16, {.max_depth = 3});
    const PixelFilter filter(FilterShape::Box);
    const auto scratch = split.make_scratch();
    std::vector<Rgb> sums(256);
    for (std::uint32_t first = 0; first < kSamples; first += job_samples) {
        TileJob job{{0, 0, 16, 16}, {0, 0, 16, 16}, 16, 16, first, job_samples, 1, SampleSequence::Sobol, &filter};
        job.aovs = aovs;
        TileBuffer tile;
        tile.reset(job.rect, aovs != nullptr ? aovs->layout : LayerLayout{});
        RenderCounters counters;
        split.render_tile(world, job, *scratch, tile, counters);
        for (std::size_t i = 0; i < sums.size(); ++i)
            sums[i] += Rgb(static_cast<float>(tile.pixel(i).r), static_cast<float>(tile.pixel(i).g),
                           static_cast<float>(tile.pixel(i).b));
    }
    return sums;
}

// Those of large jobs are traced while others are still made, those of small ones all at once.
TEST(LightSamples, CountOnceHoweverManyRaysAreTracedTogether) {
    const AgreementCase& room = agreement_case("LampPlastic");
    const World world = agreement_world(room);
    const AovSet aovs = expression_layers(room, {"C .* L"});
    for (const AovSet* followed : {static_cast<const AovSet*>(nullptr), &aovs}) {
        const std::vector<Rgb> together = pixels_in_jobs(world, followed, 32);
        const std::vector<Rgb> apart = pixels_in_jobs(world, followed, 1);
        for (std::size_t i = 0; i < together.size(); ++i) EXPECT_NEAR(together[i].g, apart[i].g, 1e-4f * apart[i].g);
    }
}

TEST(LightSamples, SayWhereTheyHaveNoEffect) {
    const World world = agreement_world(agreement_case("LampDiffuse"));
    EXPECT_TRUE(path_with(4).ineffective_options(world).empty());
    const auto short_paths = path_with(4, {.max_depth = 1}).ineffective_options(world);
    ASSERT_EQ(short_paths.size(), 1u);
    EXPECT_NE(short_paths[0].find("--max-depth"), std::string::npos) << short_paths[0];
    const World sky = agreement_world(agreement_case("Environment"));
    const auto not_sampled = path_with(4).ineffective_options(sky);
    ASSERT_EQ(not_sampled.size(), 1u);
    EXPECT_NE(not_sampled[0].find("no light is sampled"), std::string::npos) << not_sampled[0];
    EXPECT_TRUE(path_with(1).ineffective_options(sky).empty());
}

// Shadow rays are traced before there are many more of them than a batch.
TEST(LightSamples, NeedNoMoreMemoryTheMoreThereAre) {
    const AgreementCase& room = agreement_case("LampDiffuse");
    const World world = agreement_world(room);
    const PathIntegrator split = path_with(64);
    const auto scratch = split.make_scratch();
    const PixelFilter filter(FilterShape::Box);
    const TileJob job{{0, 0, 16, 16}, {0, 0, 16, 16}, 16, 16, 0, 32, 1, SampleSequence::Sobol, &filter};
    TileBuffer tile;
    tile.reset(job.rect);
    RenderCounters counters;
    split.render_tile(world, job, *scratch, tile, counters);
    EXPECT_GT(counters.rays[RayKind::Shadow], 200'000u);
    EXPECT_LT(scratch->bytes(), std::size_t{6} << 20);
}

}  // namespace

}  // namespace etendue::test
