// Renders that are profiled: the same image, and figures that belong together.
#include "render/render_profile.h"

#include "render/render_test_scene.h"

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

/// Every path has one end and one length.
std::uint64_t paths_of(const PathTally& tally) {
    std::uint64_t ended = 0;
    for (std::size_t i = 0; i < kPathEndings; ++i) ended += tally.paths(static_cast<PathEnding>(i));
    std::uint64_t lengths = 0;
    for (const std::uint64_t count : tally.lengths()) lengths += count;
    EXPECT_EQ(lengths, ended);
    return ended;
}

std::uint64_t rays_of(const PathTally& tally) {
    const std::vector<std::uint64_t> lengths = tally.lengths();
    std::uint64_t rays = 0;
    for (std::size_t n = 0; n < lengths.size(); ++n) rays += n * lengths[n];
    return rays;
}

class Profiled : public testing::TestWithParam<const char*> {};

TEST_P(Profiled, TheImageIsTheSameAndTheFiguresAddUp) {
    constexpr int kWidth = 100;
    constexpr int kHeight = 70;
    constexpr int kThreads = 2;
    constexpr std::size_t kRecorded = 2048;
    const World world = compile(busy_scene(kWidth, kHeight));
    const ThreadPool pool(kThreads);
    const std::atomic<bool> stop{false};
    // Paths short enough for some to end by it.
    const auto integrator = make_integrator(GetParam(), {.lengths = {.max_depth = 5}});
    const auto render_with = [&](const RenderOptions& o) { return render(world, *integrator, o, pool, stop, {}); };
    RenderOptions options = options_for(kWidth, kHeight, 6);
    const RenderResult plain = render_with(options);
    RenderProfile profile(kThreads, kRecorded);
    options.profile = &profile;
    const RenderResult profiled = render_with(options);
    EXPECT_TRUE(same_bytes(profiled.film.resolve(), plain.film.resolve()));
    EXPECT_EQ(profiled.counters.rays.counts, plain.counters.rays.counts);

    const WaveProfile waves = profile.total();
    double seconds = profile.splat_seconds();
    for (std::size_t i = 0; i < kStages; ++i) seconds += waves.clock().seconds(static_cast<Stage>(i));
    EXPECT_LE(seconds, kThreads * profiled.wall_seconds);
    EXPECT_GT(seconds, 0.0);
    double tracing = 0.0;
    for (std::size_t i = 0; i < kRayKinds; ++i) {
        const auto kind = static_cast<RayKind>(i);
        const std::uint64_t rays = profiled.counters.rays[kind];
        EXPECT_LE(waves.hits(kind), rays);
        EXPECT_EQ(waves.clock().seconds(kind) > 0.0, rays > 0) << kRayKindNames[i];
        EXPECT_EQ(waves.recorder(kind).ray_count() > 0, rays > 0) << kRayKindNames[i];
        EXPECT_LE(waves.recorder(kind).ray_count(), std::min<std::uint64_t>(rays, kThreads * kRecorded));
        tracing += waves.clock().seconds(kind);
    }
    EXPECT_NEAR(tracing, waves.clock().seconds(Stage::Intersect) + waves.clock().seconds(Stage::Occluded),
                1e-3 * tracing);

    const std::string name = GetParam();
    EXPECT_EQ(paths_of(waves.eye_paths()), name == "light" ? 0u : profiled.counters.samples);
    EXPECT_EQ(rays_of(waves.eye_paths()),
              profiled.counters.rays[RayKind::Primary] + profiled.counters.rays[RayKind::Bounce]);
    EXPECT_EQ(rays_of(waves.light_paths()), profiled.counters.rays[RayKind::LightSubpath]);
    if (name == "light" || name == "bdpt") {
        EXPECT_GT(paths_of(waves.light_paths()), 0u);
        EXPECT_LE(paths_of(waves.light_paths()), profiled.counters.samples) << "black emissions trace no ray";
        EXPECT_GT(waves.light_paths().paths(PathEnding::TooLong), 0u);
        EXPECT_LE(waves.light_paths().lengths().size(), 4u + 1u) << "one edge is left for the way to the camera";
    }

    // Of what an eye path's BSDFs and phase functions have sampled, each is followed by a ray unless the path ends by
    // it.
    const SampleUse& use = waves.use();
    EXPECT_EQ(use.bsdf_samples + use.phase_samples, profiled.counters.rays[RayKind::Bounce] +
                                                        waves.eye_paths().paths(PathEnding::Absorbed) +
                                                        waves.eye_paths().paths(PathEnding::Roulette));
    EXPECT_LE(use.bsdf_met_light, use.bsdf_samples + use.phase_samples);
    EXPECT_EQ(use.bsdf_met_light > 0, name != "light") << "subpaths from lights are none of the eye's";
    EXPECT_EQ(use.light_samples > 0, name == "path" || name == "bdpt");

    std::uint64_t pixels = 0;
    for (const TileTime& tile : profile.tiles()) {
        EXPECT_LE(tile.start, tile.end);
        EXPECT_GE(tile.slot, 0);
        EXPECT_LT(tile.slot, kThreads);
        pixels += tile.samples;
    }
    EXPECT_EQ(pixels, profiled.counters.samples);
}

INSTANTIATE_TEST_SUITE_P(Integrators, Profiled, testing::Values("path", "naive", "light", "bdpt"),
                         [](const auto& one) { return std::string(one.param); });

TEST(RenderProfile, EveryShadowRayIsOfALightSampleInMediaToo) {
    SceneDesc scene = empty_scene();
    scene.settings.film.width = scene.settings.film.height = 24;
    MaterialDesc fog;
    fog.metallic = 0.0f;
    fog.roughness = 0.0f;
    fog.transmission = 1.0f;
    fog.ior = 1.0f;
    fog.volume = {
        .closed = true, .attenuation_color = Rgb(0.5f), .attenuation_distance = 0.8f, .multiscatter_color = Rgb(0.8f)};
    add_object(scene, sphere({0, 0, -3}, 2.0f, 16), add_material(scene, fog));
    add_object(scene, sphere({0.3f, 0.2f, -3}, 0.4f, 8), add_material(scene, emissive(Rgb(2.0f))));
    const World world = compile(std::move(scene));
    ASSERT_TRUE(world.traits().samples_lights_in_media);
    for (const char* integrator : {"path", "bdpt"}) {
        RenderProfile profile(1, 0);
        RenderOptions options = options_for(24, 24, 16);
        options.profile = &profile;
        const std::uint64_t shadow_rays = render_now(world, integrator, options, 1).counters.rays[RayKind::Shadow];
        EXPECT_GT(shadow_rays, 0u) << integrator;
        EXPECT_LE(shadow_rays, profile.total().use().light_samples) << integrator;
    }
}

TEST(RenderProfile, EveryShadowRayOfACatcherIsOfALightSample) {
    SceneDesc scene = empty_scene();
    scene.settings.film.width = scene.settings.film.height = 24;
    MaterialDesc catcher = diffuse(Rgb(0.5f));
    catcher.seen_as = SeenAs::Shadow;
    add_object(scene, sphere({0, 0, -3}, 1.0f, 16), add_material(scene, catcher));
    add_object(scene, sphere({0, 3, 0}, 0.4f, 8), add_material(scene, emissive(Rgb(2.0f))));
    const World world = compile(std::move(scene));
    RenderProfile profile(1, 0);
    RenderOptions options = options_for(24, 24, 16);
    options.profile = &profile;
    const std::uint64_t shadow_rays = render_now(world, "path", options, 1).counters.rays[RayKind::Shadow];
    EXPECT_GT(shadow_rays, 0u);
    EXPECT_LE(shadow_rays, profile.total().use().light_samples);
}

TEST(RenderProfile, IsOfAllThreads) {
    RenderProfile profile(2, 0);
    profile.wave(0).count_eye_path_end(PathEnding::Escaped, {.rays = 1});
    profile.wave(1).count_eye_path_end(PathEnding::Escaped, {.rays = 2});
    profile.add_tile({.rect = {0, 0, 1, 1}, .slot = 1, .start = 1.0, .end = 2.0});
    profile.add_tile({.rect = {1, 0, 2, 1}, .slot = 0, .start = 0.5, .end = 3.0});
    profile.add_splatting(0.25);
    profile.add_splatting(0.5);
    EXPECT_EQ(profile.total().eye_paths().paths(PathEnding::Escaped), 2u);
    EXPECT_EQ(profile.total().eye_paths().lengths(), (std::vector<std::uint64_t>{0, 1, 1}));
    EXPECT_EQ(profile.splat_seconds(), 0.75);
    ASSERT_EQ(profile.tiles().size(), 2u);
    EXPECT_EQ(profile.tiles().front().slot, 0) << "by their beginnings";
}

TEST(RayKinds, EachIntegratorTracesItsOwn) {
    const World world = compile(busy_scene(40, 30));
    const auto kinds_of = [&](const char* integrator) {
        const RaysByKind rays = render_now(world, integrator, options_for(40, 30, 2), 1).counters.rays;
        std::string kinds;
        for (std::size_t i = 0; i < kRayKinds; ++i)
            if (rays[static_cast<RayKind>(i)] > 0) kinds += std::string(kRayKindNames[i]) + " ";
        return kinds;
    };
    EXPECT_EQ(kinds_of("naive"), "camera bounce lamp-in-view ");
    EXPECT_EQ(kinds_of("path"), "camera bounce shadow lamp-in-view lamp-image ");
    EXPECT_EQ(kinds_of("light"), "light-subpath light-to-camera ");
    EXPECT_EQ(kinds_of("bdpt"),
              "camera bounce shadow light-subpath connection light-to-camera lamp-in-view lamp-image ");
    EXPECT_EQ(kinds_of("normals"), "camera ");
}

}  // namespace

}  // namespace etendue::test
