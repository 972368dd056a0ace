// Connections to light vertices of all samples of a wave: they make the image that those within each sample make.
#include "integrator/bdpt/bdpt_job.h"
#include "integrator/bdpt/render_bdpt.h"
#include "integrator/closed_form_scene.h"
#include "world/test_scene.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

/// Pixels share light vertices, so that only images with other seeds are independent.
MeanEstimate estimate(const World& world, const IntegratorSettings& options, std::uint32_t first_seed) {
    constexpr std::uint32_t kSeeds = 8;
    constexpr std::uint32_t kSpp = 16;
    std::vector<double> means;
    for (std::uint32_t i = 0; i < kSeeds; ++i)
        means.push_back(mean_of(render_bdpt(world, options, kSpp, first_seed + i)));
    return MeanEstimate(means);
}

/// Seeds are fixed. At most four standard errors apart, which are at most 2% together.
void expect_same_mean(const World& world, IntegratorSettings options, const std::string& what) {
    options.cached_connections = 0;
    const MeanEstimate pairwise = estimate(world, options, 100);
    for (const int count : {1, 3}) {
        options.cached_connections = count;
        const MeanEstimate cached = estimate(world, options, 200);
        const double error = std::hypot(pairwise.error, cached.error);
        EXPECT_LE(error, 0.02 * pairwise.mean) << what;
        EXPECT_NEAR(cached.mean, pairwise.mean, 4.0 * error) << what << ", cache:" << count;
    }
}

class CachedConnections : public testing::TestWithParam<const char*> {};

TEST_P(CachedConnections, MakeTheSameImage) {
    const AgreementCase& agreement = agreement_case(GetParam());
    expect_same_mean(agreement_world(agreement), {.lengths = agreement.lengths}, agreement.name);
}

INSTANTIATE_TEST_SUITE_P(Rooms, CachedConnections,
                         testing::Values("LampPlastic", "LampRoughGlass", "CloudUnderLamp", "LongPathsAndRoulette"),
                         [](const auto& param) { return std::string(param.param); });

/// A spot lights a wall in a disc of 2 cm, and the camera looks at nearly one point of a floor, so that all connections
/// of the one to the other bring the same, up to a few hundredths. Of all light the share `left` passes a metre.
World two_places(float left) {
    SceneDesc scene;
    scene.settings.film.width = kAgreementWidth;
    scene.settings.film.height = kAgreementHeight;
    // So small that light paths do not meet it: of theirs only the first vertices are in the cache.
    add(scene, parallelogram({0, 0, 0}, {0, 0, 0.01f}, {0.01f, 0, 0}), diffuse(0.6f));
    add(scene, parallelogram({1, 1, 0}, {1, -1, 0}, {0, 0, 1}), diffuse(0.6f));
    MaterialDesc air;
    air.metallic = 0.0f;
    air.roughness = 0.0f;
    air.transmission = 1.0f;
    air.ior = 1.0f;
    air.volume = {.closed = true, .attenuation_color = Rgb(left), .attenuation_distance = 1.0f};
    if (left < 1.0f) add(scene, sphere({0, 0, 0}, 10.0f, 2, Facing::Outwards), air);
    LightDesc& spot = add_light(scene, LightType::Spot, 1000.0f, {0.0f, 1.0f, 0.0f}, {1.0f, 0.0f, 0.0f});
    spot.outer_cone_angle = 0.02f;
    spot.inner_cone_angle = 0.01998f;
    look(scene, {0.0f, 0.5f, 0.0f}, {0.0f, -1.0f, 0.0f}, 1e-3f);
    return compile(std::move(scene));
}

/// Only the connections of the second vertices of both subpaths.
double mean_of_connections(const World& world, int cached) {
    IntegratorSettings options{.lengths = {.max_depth = 3, .min_depth = 3}, .cached_connections = cached};
    options.strategy = Strategy{2, 2};
    options.weighted = false;
    return mean_of(render_bdpt(world, options, 1, 1));
}

// However many of the cache are drawn. Deviations of one connection are some 2%, of the mean of 3072 below 0.04%: the
// tolerance is five of them.
TEST(ConnectionsOfEqualPaths, BringTheSameFromTheCache) {
    const World world = two_places(1.0f);
    const double pairwise = mean_of_connections(world, 0);
    EXPECT_GT(pairwise, 0.0);
    for (const int count : {1, 3, 64})
        EXPECT_NEAR(mean_of_connections(world, count) / pairwise, 1.0, 2e-3) << "cache:" << count;
}

// A metre from the spot to the wall, the diagonal to the floor, and half a metre to the camera.
TEST(ConnectionsOfEqualPaths, AreAbsorbedOnTheirWholeWay) {
    const double share = mean_of_connections(two_places(0.5f), 0) / mean_of_connections(two_places(1.0f), 0);
    EXPECT_NEAR(share / std::pow(0.5, 1.0 + std::sqrt(2.0) + 0.5), 1.0, 2e-3);
}

// Of the strategies only those with vertices in between are concerned; each is right alone.
TEST(CachedConnectionsOfAStrategy, MakeItsImage) {
    constexpr int kEdges = 4;
    const World world = agreement_world(agreement_case("LampDiffuse"));
    for (int s = 2; s < kEdges; ++s) {
        IntegratorSettings options{.lengths = {.max_depth = kEdges, .min_depth = kEdges}};
        options.strategy = Strategy{s, kEdges + 1 - s};
        expect_same_mean(world, options, "s = " + std::to_string(s));
    }
}

// The same random numbers, whatever else is asked for.
TEST(CachedConnectionsOfAStrategy, AddUpToTheWhole) {
    constexpr int kEdges = 4;
    const World world = agreement_world(agreement_case("LampPlastic"));
    IntegratorSettings options{.lengths = {.max_depth = kEdges, .min_depth = kEdges}, .cached_connections = 2};
    const double whole = mean_of(render_bdpt(world, options, 16, 7));
    double sum = 0.0;
    for (int s = 0; s <= kEdges; ++s) {
        options.strategy = Strategy{s, kEdges + 1 - s};
        sum += mean_of(render_bdpt(world, options, 16, 7));
    }
    EXPECT_NEAR(sum / whole, 1.0, 1e-5);
}

TEST(CachedConnectionsOfThreads, AreTheSame) {
    const World world = agreement_world(agreement_case("LampPrism"));
    const IntegratorSettings options{.lengths = {.max_depth = 6}, .cached_connections = 2};
    const std::vector<float> one = render_bdpt(world, options, 8, 3, 1);
    EXPECT_EQ(one, render_bdpt(world, options, 8, 3, 3));
    IntegratorSettings pairwise = options;
    pairwise.cached_connections = 0;
    EXPECT_NE(one, render_bdpt(world, pairwise, 8, 3, 1));
}

// Each sample has a wavelength of its own: a path of vertices of two samples must not have two.
TEST(CachedConnectionsOfOneWavelength, AreThoseOfEachSample) {
    const World world = agreement_world(agreement_case("LampPrism"));
    const TileJob tile{};
    const IntegratorSettings settings{.cached_connections = 2};
    const BdptJob job{
        {.mis = {.world = world}, .job = tile, .lengths = settings.lengths, .samples = {}, .camera_rays = {}},
        settings};
    ConnectibleVertex vertex{};
    EXPECT_TRUE(job.is_shared(vertex));
    vertex.is_dispersed = true;
    EXPECT_FALSE(job.is_shared(vertex));
}

// Each sample has a time of its own: where something moves, vertices of others are elsewhere by then.
TEST(CachedConnectionsInMotion, AreThoseOfEachSample) {
    AgreementCase moving = agreement_case("LampDiffuse");
    moving.make = [make = moving.make](SceneDesc& scene) {
        make(scene);
        Mat4f aside;
        aside.setTranslation(Vec3f(0.05f, 0.0f, 0.0f));
        scene.instances.front().motion = {Mat4f(), aside};
    };
    const World world = agreement_world(moving);
    ASSERT_TRUE(world.traits().has_motion);
    IntegratorSettings options{.lengths = {.max_depth = 6}};
    const std::vector<float> pairwise = render_bdpt(world, options, 8, 3);
    options.cached_connections = 4;
    EXPECT_EQ(pairwise, render_bdpt(world, options, 8, 3));
    const auto said = BdptIntegrator(options).ineffective_options(world);
    ASSERT_EQ(said.size(), 1u);
    EXPECT_NE(said.front().find("cache:4"), std::string::npos) << said.front();
    EXPECT_TRUE(BdptIntegrator(options).ineffective_options(agreement_world(agreement_case("LampDiffuse"))).empty());
    options.cached_connections = 0;
    EXPECT_TRUE(BdptIntegrator(options).ineffective_options(world).empty());
}

}  // namespace

}  // namespace etendue::test
