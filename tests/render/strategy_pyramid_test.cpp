#include "render/strategy_pyramid.h"

#include "render/whole_image.h"
#include "world/test_scene.h"

#include <atomic>
#include <cstddef>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

TEST(StrategiesBetween, AreAllThatExist) {
    const std::vector<Strategy> seen = strategies_between(1, 1);
    EXPECT_EQ(seen, (std::vector<Strategy>{{0, 2}, {1, 1}})) << "a light that the camera sees";
    EXPECT_EQ(strategies_between(2, 3),
              (std::vector<Strategy>{{0, 3}, {1, 2}, {2, 1}, {0, 4}, {1, 3}, {2, 2}, {3, 1}}));
    for (const Strategy& strategy : strategies_between(1, 9)) EXPECT_TRUE(strategy.exists());
    for (const Strategy& strategy : {Strategy{0, 1}, Strategy{3, 0}, Strategy{-1, 4}})
        EXPECT_FALSE(strategy.exists()) << strategy.s << "," << strategy.t;
}

/// A floor under a lamp that the camera sees.
World lamp_above_floor() {
    SceneDesc scene = empty_scene();
    add_object(scene, quad({0, -0.6f, -3}, {1.2f, 0, 0}, {0, 0, -1.2f}), add_material(scene, diffuse(Rgb(0.7f))));
    add_object(scene, quad({0, 0.6f, -3}, {0.4f, 0, 0}, {0, 0, 0.4f}), add_material(scene, emissive(Rgb(6.0f))));
    return compile(std::move(scene));
}

TEST(RenderStrategies, WeightedOnesAddUpToTheImage) {
    const ThreadPool threads(2);
    const World world = lamp_above_floor();
    const RenderOptions options = whole_image(24, 16, 4);
    const IntegratorSettings integrator{.type = "bdpt", .lengths = {.max_depth = 4}, .lamp_images = false};
    const std::atomic<bool> stop{false};
    const std::vector<Strategy> strategies = strategies_between(1, 4);
    double last_fraction = 0.0;
    const std::vector<StrategyImage> images =
        render_strategies(world, integrator, strategies, options, threads, stop, [&](const RenderProgress& progress) {
            EXPECT_GE(progress.fraction, last_fraction);
            last_fraction = progress.fraction;
        });
    EXPECT_EQ(last_fraction, 1.0);
    ASSERT_EQ(images.size(), strategies.size());
    const std::vector<float> whole =
        render(world, *make_integrator("bdpt", integrator), options, threads, stop, {}).film.resolve();
    double total = 0.0;
    for (std::size_t i = 0; i < whole.size(); ++i) {
        if (i % 4 == 3) continue;  // alpha
        double sum = 0.0;
        for (const StrategyImage& image : images) sum += static_cast<double>(image.rgba.pixels[i]);
        EXPECT_NEAR(sum, static_cast<double>(whole[i]), 1e-4 * (1.0 + sum)) << i;
        total += sum;
    }
    EXPECT_GT(total, 1.0);
    const std::vector<ImagePart> parts = strategy_parts(images);
    ASSERT_EQ(parts.size(), images.size());
    EXPECT_EQ(parts[0].name, "s0t2");
    EXPECT_EQ(parts[4].name, "s2t1");
    EXPECT_EQ(parts[4].image, &images[4].rgba);
    EXPECT_EQ(parts[4].image->width, 24);
    EXPECT_EQ(parts[4].image->channels, 4);
}

TEST(RenderStrategies, AddUpToTheImageWhereLampsInMirrorsAreFound) {
    SceneDesc scene = empty_scene();
    MaterialDesc mirror;
    mirror.roughness = 0.0f;
    add_object(scene, quad({0, 0, -2}, {3, 0, 0}, {0, 3, 0}), add_material(scene, mirror));
    add_object(scene, quad({0.3f, 0.1f, 1}, {-0.004f, 0, 0}, {0, 0.004f, 0}), add_material(scene, emissive(Rgb(1e5f))));
    const World world = compile(std::move(scene));
    const ThreadPool threads(2);
    const std::atomic<bool> stop{false};
    const RenderOptions options =
        whole_image(12, 12, 64);  // two samples each of the lamp, of which one in ten meets it
    const IntegratorSettings integrator{.type = "bdpt", .lengths = {.max_depth = 3}};
    const std::vector<StrategyImage> images =
        render_strategies(world, integrator, strategies_between(1, 3), options, threads, stop, {});
    const std::vector<float> whole =
        render(world, *make_integrator("bdpt", integrator), options, threads, stop, {}).film.resolve();
    double found = 0.0;
    for (std::size_t i = 0; i < whole.size(); ++i) {
        if (i % 4 == 3) continue;  // alpha
        double sum = 0.0;
        for (const StrategyImage& image : images) sum += static_cast<double>(image.rgba.pixels[i]);
        EXPECT_NEAR(sum, static_cast<double>(whole[i]), 1e-4 * (1.0 + sum)) << i;
        found += sum;
    }
    EXPECT_GT(found, 1.0) << "the mirror shows the lamp";
}

TEST(RenderStrategies, OfWhatMergesAddUpWithTheMerges) {
    SceneDesc scene = empty_scene();
    add_object(scene, quad({0, -0.6f, -3}, {1.2f, 0, 0}, {0, 0, -1.2f}), add_material(scene, diffuse(Rgb(0.7f))));
    add_object(scene, quad({0, 0.6f, -3}, {0.4f, 0, 0}, {0, 0, 0.4f}), add_material(scene, emissive(Rgb(6.0f))));
    MaterialDesc glass;
    glass.override_model = DielectricDesc{1.5f, 0.0f};
    add_object(scene, sphere({0, -0.05f, -3}, 0.5f, 16), add_material(scene, glass));
    add_object(scene, sphere({0, -0.05f, -3}, 0.35f, 16), add_material(scene, diffuse(Rgb(0.6f))));
    const World world = compile(std::move(scene));
    const ThreadPool threads(2);
    const std::atomic<bool> stop{false};
    const RenderOptions options = whole_image(24, 16, 4);
    const IntegratorSettings integrator{.type = "vcm", .lengths = {.max_depth = 6}, .lamp_images = false};
    std::vector<Strategy> strategies = strategies_between(1, 6);
    strategies.push_back(kMerges);
    const std::vector<StrategyImage> images =
        render_strategies(world, integrator, strategies, options, threads, stop, {});
    const std::vector<float> whole =
        render(world, *make_integrator("vcm", integrator), options, threads, stop, {}).film.resolve();
    double merged = 0.0;
    for (std::size_t i = 0; i < whole.size(); ++i) {
        if (i % 4 == 3) continue;  // alpha
        double sum = 0.0;
        for (const StrategyImage& image : images) sum += static_cast<double>(image.rgba.pixels[i]);
        EXPECT_NEAR(sum, static_cast<double>(whole[i]), 1e-4 * (1.0 + sum)) << i;
        merged += static_cast<double>(images.back().rgba.pixels[i]);
    }
    EXPECT_GT(merged, 0.1);
    EXPECT_EQ(strategy_parts(images).back().name, "merges");
}

TEST(RenderStrategies, AStopLeavesThoseThatAreFinished) {
    const ThreadPool threads(1);
    const World world = lamp_above_floor();
    std::atomic<bool> stop{false};
    const auto images =
        render_strategies(world, {.type = "bdpt"}, strategies_between(1, 3), whole_image(8, 8, 1), threads, stop,
                          [&](const RenderProgress& progress) { stop = progress.fraction > 0.3; });
    EXPECT_GE(images.size(), 1u);
    EXPECT_LT(images.size(), 8u);
}

}  // namespace

}  // namespace etendue::test
