// Scheduling: what an image must not depend on, and how a render stops.
#include "render/render.h"

#include "render/render_test_scene.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

/// Numbers of threads, each with a seed of the order of tiles.
constexpr std::array kThreadsAndOrders{std::pair{1, 12345u}, std::pair{2, 0u}, std::pair{5, 12345u}};

/// Integrator, numbers, and whether things move.
using DeterminismCase = std::tuple<const char*, SampleSequence, bool>;

std::string name_of(const testing::TestParamInfo<DeterminismCase>& info) {
    const auto [integrator, sequence, moves] = info.param;
    return std::string(integrator) + (sequence == SampleSequence::Sobol ? "Sobol" : "Random") + (moves ? "Moving" : "");
}

class Determinism : public testing::TestWithParam<DeterminismCase> {};

TEST_P(Determinism, ThreadsAndTileOrderDoNotChangeABit) {
    constexpr int kWidth = 100;
    constexpr int kHeight = 70;
    const auto [integrator, sequence, moves] = GetParam();
    const World world = compile(busy_scene(kWidth, kHeight, moves));
    RenderOptions options = options_for(kWidth, kHeight, 6);
    options.sequence = sequence;
    const RenderResult reference = render_now(world, integrator, options, 1);
    const std::vector<float> image = reference.film.resolve();
    for (const auto& [threads, order] : kThreadsAndOrders) {
        options.tile_order_seed = order;
        const RenderResult again = render_now(world, integrator, options, threads);
        EXPECT_TRUE(same_bytes(again.film.resolve(), image)) << threads << " threads, tile order " << order;
        EXPECT_EQ(again.counters.rays.total(), reference.counters.rays.total());
    }
    // The image is one: it has light, darkness, and pixels that are partly covered.
    std::set<float> alphas;
    float brightest = 0.0f;
    for (std::size_t i = 0; i < image.size(); i += 4) {
        alphas.insert(image[i + 3]);
        brightest = std::max(brightest, image[i]);
    }
    EXPECT_GT(brightest, 0.1f);
    EXPECT_GT(alphas.size(), 3u);
    // Another seed is another image.
    options.seed = 6;
    EXPECT_FALSE(same_bytes(render_now(world, integrator, options, 2).film.resolve(), image));
}

TEST_P(Determinism, ACropIsThePartOfTheWholeBitForBit) {
    constexpr int kWidth = 100;
    constexpr int kHeight = 70;
    const auto [integrator, sequence, moves] = GetParam();
    const World world = compile(busy_scene(kWidth, kHeight, moves));
    RenderOptions options = options_for(kWidth, kHeight, 5);
    options.sequence = sequence;
    const std::vector<float> whole = render_now(world, integrator, options, 2).film.resolve();
    const PixelRect crops[] = {{13, 21, 81, 60}, {0, 0, 33, 1}, {99, 69, 100, 70}};
    for (const PixelRect& crop : crops) {
        options.window = crop;
        const std::vector<float> part = render_now(world, integrator, options, 2).film.resolve();
        ASSERT_EQ(part.size(), crop.area() * 4);
        for (int y = crop.y0; y < crop.y1; ++y) {
            const auto row = static_cast<std::size_t>(crop.width()) * 4;
            const float* expected = &whole[static_cast<std::size_t>(y * kWidth + crop.x0) * 4];
            const float* actual = &part[static_cast<std::size_t>(y - crop.y0) * row];
            EXPECT_EQ(std::memcmp(expected, actual, row * sizeof(float)), 0) << "row " << y;
        }
    }
    const PixelRect beyond{-9, -7, kWidth + 4, kHeight + 3};
    options.window = beyond;
    const std::vector<float> larger = render_now(world, integrator, options, 2).film.resolve();
    for (int y = 0; y < kHeight; ++y) {
        const float* expected = &whole[static_cast<std::size_t>(y * kWidth) * 4];
        const float* actual = &larger[static_cast<std::size_t>((y - beyond.y0) * beyond.width() - beyond.x0) * 4];
        EXPECT_TRUE(std::equal(actual, actual + kWidth * 4, expected)) << "row " << y << " with overscan";
    }
}

INSTANTIATE_TEST_SUITE_P(Render, Determinism,
                         testing::Combine(testing::Values("path", "naive", "direct", "whitted"),
                                          testing::Values(SampleSequence::Sobol, SampleSequence::Random),
                                          testing::Bool()),
                         name_of);

/// A film, the part of it that is rendered, and samples per pixel.
struct Sheet {
    int width;
    int height;
    PixelRect window;
    std::uint32_t spp;
};

// What falls into other tiles' pixels must not depend on them either.
class SplatDeterminism : public testing::TestWithParam<DeterminismCase> {};

TEST_P(SplatDeterminism, ThreadsAndTileOrderDoNotChangeABit) {
    const auto [integrator, sequence, moves] = GetParam();
    // A crop, and a row with more tiles than a group of splat lists holds in passes of 16 samples.
    const Sheet sheets[] = {{100, 70, {13, 21, 81, 60}, 24}, {2112, 70, {0, 40, 2112, 41}, 32}};
    for (const Sheet& sheet : sheets) {
        const World world = compile(busy_scene(sheet.width, sheet.height, moves));
        RenderOptions options = options_for(sheet.width, sheet.height, sheet.spp);
        options.window = sheet.window;
        options.sequence = sequence;
        const RenderResult reference = render_now(world, integrator, options, 1);
        const std::vector<float> image = reference.film.resolve();
        EXPECT_GT(*std::ranges::max_element(image), 0.1f);
        for (const auto& [threads, order] : kThreadsAndOrders) {
            options.tile_order_seed = order;
            const RenderResult again = render_now(world, integrator, options, threads);
            EXPECT_TRUE(same_bytes(again.film.resolve(), image)) << threads << " threads, tile order " << order;
            EXPECT_EQ(again.counters.rays.total(), reference.counters.rays.total());
        }
        options.seed = 6;
        EXPECT_FALSE(same_bytes(render_now(world, integrator, options, 2).film.resolve(), image));
    }
}

INSTANTIATE_TEST_SUITE_P(Render, SplatDeterminism,
                         testing::Combine(testing::Values("light", "bdpt", "vcm"),
                                          testing::Values(SampleSequence::Sobol, SampleSequence::Random),
                                          testing::Bool()),
                         name_of);

TEST(Render, CountsSamplesAndRays) {
    const World world = compile(busy_scene(50, 40));
    const RenderOptions options = options_for(50, 40, 7);
    const RenderResult result = render_now(world, "path", options, 2);
    EXPECT_EQ(result.halt_reason, HaltReason::SamplesDone);
    EXPECT_EQ(result.spp_done, 7u);
    EXPECT_EQ(result.counters.samples, 50u * 40u * 7u);
    EXPECT_EQ(result.film.sample_count(), 50u * 40u * 7u);
    EXPECT_EQ(result.counters.rays[RayKind::Primary], 50u * 40u * 7u);
    EXPECT_GT(result.counters.rays[RayKind::Bounce], 0u);
    EXPECT_GT(result.counters.rays[RayKind::Shadow], 0u);
    EXPECT_EQ(result.counters.dropped, 0u);
    EXPECT_GT(result.wall_seconds, 0.0);
    EXPECT_EQ(render_now(world, "naive", options, 2).counters.rays[RayKind::Shadow], 0u);
}

TEST(Render, ProgressGrowsAndEndsAtOne) {
    const World world = compile(busy_scene(64, 64));
    std::vector<RenderProgress> reports;
    const RenderResult result =
        render_now(world, "path", options_for(64, 64, 16), 2, [&](const RenderProgress& p) { reports.push_back(p); });
    ASSERT_FALSE(reports.empty());
    EXPECT_DOUBLE_EQ(reports.back().fraction, 1.0);
    EXPECT_EQ(reports.back().samples, result.counters.samples);
    EXPECT_EQ(reports.back().rays, result.counters.rays.total());
    for (std::size_t i = 1; i < reports.size(); ++i) {
        EXPECT_GE(reports[i].fraction, reports[i - 1].fraction);
        EXPECT_GE(reports[i].seconds, reports[i - 1].seconds);
    }
}

TEST(Render, AStopFlagThatIsSetRendersNothing) {
    const World world = compile(busy_scene(40, 40));
    const ThreadPool pool(2);
    const std::atomic<bool> stop{true};
    const RenderResult result = render(world, *make_integrator("path", {}), options_for(40, 40, 4), pool, stop, {});
    EXPECT_EQ(result.halt_reason, HaltReason::Interrupted);
    EXPECT_EQ(result.spp_done, 0u);
    EXPECT_EQ(result.film.sample_count(), 0u);
    for (const float value : result.film.resolve()) EXPECT_EQ(value, 0.0f);
}

TEST(Render, StoppingOnTheWayKeepsFinishedTiles) {
    const World world = compile(busy_scene(96, 96));
    const ThreadPool pool(2);
    std::atomic<bool> stop{false};
    // No report comes before a tenth of a second; what was done by then is kept.
    const RenderOptions options = options_for(96, 96, 1u << 20);
    const RenderResult result =
        render(world, *make_integrator("path", {}), options, pool, stop, [&](const RenderProgress&) { stop = true; });
    EXPECT_EQ(result.halt_reason, HaltReason::Interrupted);
    EXPECT_GT(result.film.sample_count(), 0u);
    EXPECT_EQ(result.film.sample_count(), result.counters.samples);
    EXPECT_GE(result.film.sample_count(), std::uint64_t{96 * 96} * result.spp_done);
    EXPECT_LT(result.spp_done, options.spp);
}

TEST(Render, TheTimeLimitStopsBetweenPassesAndAgreesWithAShorterRender) {
    const World world = compile(busy_scene(64, 64));
    RenderOptions options = options_for(64, 64, 1u << 20);
    options.time_limit_seconds = 0.15;
    const RenderResult result = render_now(world, "path", options, 2);
    EXPECT_EQ(result.halt_reason, HaltReason::TimeLimit);
    ASSERT_GT(result.spp_done, 0u);
    EXPECT_EQ(result.film.sample_count(), std::uint64_t{64 * 64} * result.spp_done);
    options.time_limit_seconds = 0.0;
    options.spp = result.spp_done;
    EXPECT_TRUE(same_bytes(render_now(world, "path", options, 2).film.resolve(), result.film.resolve()));
}

TEST(Render, ProgressIsThatOfTheLimitOfTime) {
    const World world = compile(busy_scene(64, 64));
    RenderOptions options = options_for(64, 64, 1u << 20);
    options.time_limit_seconds = 0.5;
    std::vector<RenderProgress> told;
    (void)render_now(world, "path", options, 2, [&](const RenderProgress& now) { told.push_back(now); });
    ASSERT_GT(told.size(), 2u);
    EXPECT_EQ(told.back().fraction, 1.0);
    for (const RenderProgress& now : told)
        EXPECT_GE(now.fraction, std::min(1.0, now.seconds / options.time_limit_seconds) - 1e-9);
}

TEST(Render, SamplesThatOverflowAreDroppedCountedAndLocated) {
    // One wall in the left half shines so brightly that two reflections overflow.
    SceneDesc scene = empty_scene();
    scene.settings.film.width = 32;
    scene.settings.film.height = 32;
    MaterialDesc glare = diffuse(Rgb(0.0f));
    glare.emissive = Rgb(1.0f);
    glare.emissive_strength = 3e38f;
    add_object(scene, quad({-1, 0, -1}, {0.9f, 0, 0}, {0, 1, 0}), add_material(scene, glare));
    LightDesc lamp;
    lamp.intensity = 3e38f;
    lamp.to_world = translation({0.5f, 0, -0.9f});
    scene.lights.push_back(lamp);
    add_object(scene, quad({1, 0, -1}, {0.9f, 0, 0}, {0, 1, 0}), add_material(scene, diffuse(Rgb(1.0f))));
    const World world = compile(std::move(scene));
    RenderOptions options = options_for(32, 32, 4);
    options.filter = PixelFilter(FilterShape::Box);
    const RenderResult result = render_now(world, "direct", options, 2);
    EXPECT_GT(result.counters.dropped, 0u);
    EXPECT_EQ(result.counters.samples, 32u * 32u * 4u);
    ASSERT_EQ(result.counters.first_dropped.size(), RenderCounters::kMaxLocated);
    for (const DroppedSample& dropped : result.counters.first_dropped) {
        EXPECT_GE(dropped.x, 16);
        EXPECT_LT(dropped.x, 32);
        EXPECT_TRUE(dropped.y >= 0 && dropped.y < 32);
        EXPECT_LT(dropped.sample, 4u);
        // Rendering that pixel alone finds it again.
        RenderOptions one = options;
        one.window = {dropped.x, dropped.y, dropped.x + 1, dropped.y + 1};
        one.spp = dropped.sample + 1;
        const RenderResult replay = render_now(world, "direct", one, 1);
        ASSERT_FALSE(replay.counters.first_dropped.empty());
        EXPECT_EQ(replay.counters.first_dropped.back().sample, dropped.sample);
    }
    for (const float value : result.film.resolve()) EXPECT_TRUE(std::isfinite(value));
}

}  // namespace

}  // namespace etendue::test
