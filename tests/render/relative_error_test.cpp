// When a render ends for the error that its image has, and whether that error is what is said.
#include "film/error_estimate.h"
#include "render/render.h"
#include "render/render_test_scene.h"

#include <atomic>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr int kEstimateWidth = 80;
constexpr int kEstimateHeight = 50;

RenderResult render_with_estimate(const World& world, const char* integrator, const RenderOptions& options) {
    const ThreadPool pool(2);
    const std::atomic<bool> never{false};
    RenderState state{.film = make_film(options)};
    state.every_other_pass = make_film(options);
    return render(world, *make_integrator(integrator, {}), options, pool, never, {}, {}, std::move(state));
}

TEST(RelativeError, EndsTheRenderAndIsKept) {
    const World world = compile(busy_scene(kEstimateWidth, kEstimateHeight));
    RenderOptions options = options_for(kEstimateWidth, kEstimateHeight, 4096);
    options.relative_error = 0.2;
    for (const char* integrator : {"path", "bdpt"}) {
        const RenderResult result = render_with_estimate(world, integrator, options);
        EXPECT_EQ(result.halt_reason, HaltReason::ErrorReached) << integrator;
        EXPECT_LT(result.spp_done, options.spp) << integrator;
        ASSERT_TRUE(relative_error(result)) << integrator;
        EXPECT_LE(*relative_error(result), options.relative_error) << integrator;
        // The same samples as a render that is as long.
        RenderOptions same = options_for(kEstimateWidth, kEstimateHeight, result.spp_done);
        EXPECT_TRUE(same_bytes(result.film.resolve(), render_now(world, integrator, same, 2).film.resolve()));
    }
}

// The passes that are kept apart have 1 + 4 + 16 samples by then, the others 1 + 2 + 8 and what comes after 32.
TEST(RelativeError, IsKnownOnceBothPartsHave16Samples) {
    const World world = compile(busy_scene(kEstimateWidth, kEstimateHeight));
    for (const std::uint32_t spp : {1u, 16u, 32u, 36u})
        EXPECT_FALSE(
            relative_error(render_with_estimate(world, "path", options_for(kEstimateWidth, kEstimateHeight, spp))))
            << spp;
    for (const std::uint32_t spp : {37u, 48u})
        EXPECT_TRUE(
            relative_error(render_with_estimate(world, "path", options_for(kEstimateWidth, kEstimateHeight, spp))))
            << spp;
}

TEST(RelativeError, NoRenderEndsBeforeItIsKnownHoweverLargeTheLimit) {
    const World world = compile(busy_scene(kEstimateWidth, kEstimateHeight));
    RenderOptions options = options_for(kEstimateWidth, kEstimateHeight, 4096);
    for (const double limit : {1.0, 100.0}) {
        options.relative_error = limit;
        const RenderResult result = render_with_estimate(world, "path", options);
        EXPECT_EQ(result.halt_reason, HaltReason::ErrorReached);
        EXPECT_EQ(result.spp_done, 48u);
    }
}

/// The root of the mean squared relative error; what is darker than half of the reference's scale, by that.
double measured_error(const std::vector<float>& image, const Film& truth_film) {
    const std::vector<float> reference = truth_film.resolve();
    const double dark = std::pow(0.5 * image_scale(truth_film, ThreadPool(2)), 2.0);
    double sum = 0.0;
    for (std::size_t i = 0; i < image.size(); ++i) {
        if (i % 4 == 3) continue;  // alpha
        const auto truth = static_cast<double>(reference[i]);
        sum += std::pow(static_cast<double>(image[i]) - truth, 2.0) / (truth * truth + dark);
    }
    return std::sqrt(sum / (0.75 * static_cast<double>(image.size())));
}

// Splats: what light subpaths leave depends on the passes, and on nothing that pixels alone know. Rare bright ones that
// have not come yet are missing in both parts, so that the estimate is too low rather than too high: by 6% here.
TEST(RelativeError, IsThatOfALongReferenceForLightSubpaths) {
    constexpr std::uint32_t kSeeds = 8;
    const World world = compile(busy_scene(40, 25));
    RenderOptions options = options_for(40, 25, 4096);
    options.sequence = SampleSequence::Random;
    options.seed = 99;
    const Film reference = render_now(world, "light", options, 2).film;
    options.spp = 256;
    double estimate = 0.0;
    double error = 0.0;
    for (options.seed = 1; options.seed <= kSeeds; ++options.seed) {
        const RenderResult result = render_with_estimate(world, "light", options);
        ASSERT_TRUE(relative_error(result));
        estimate += *relative_error(result) / kSeeds;
        error += measured_error(result.film.resolve(), reference) / kSeeds;
    }
    EXPECT_NEAR(estimate, error, 0.1 * error);
}

/// Multiplies all light by `factor`.
SceneDesc dimmed(SceneDesc scene, float factor) {
    for (MaterialDesc& material : scene.materials) material.emissive_strength *= factor;
    for (LightDesc& light : scene.lights) light.intensity *= factor;
    scene.environment.color = scene.environment.color * factor;
    return scene;
}

// Light is linear. A power of two changes no bit of any number but its exponent.
TEST(RelativeError, TakesAsManySamplesWhateverTheUnitOfLight) {
    for (const char* integrator : {"path", "bdpt"}) {
        const auto samples = [&](float factor) {
            const World world = compile(dimmed(busy_scene(kEstimateWidth, kEstimateHeight), factor));
            RenderOptions options = options_for(kEstimateWidth, kEstimateHeight, 4096);
            options.relative_error = 0.07;
            options.adaptive = true;
            const RenderResult result = render_with_estimate(world, integrator, options);
            EXPECT_EQ(result.halt_reason, HaltReason::ErrorReached);
            EXPECT_GT(result.counters.samples, 52u * options.window.area()) << "something was decided";
            return result.adaptive.samples;
        };
        const std::vector<std::uint32_t> bright = samples(1.0f);
        EXPECT_EQ(samples(0x1p-10f), bright) << integrator;
        const auto sum = [](const std::vector<std::uint32_t>& all) {
            return std::accumulate(all.begin(), all.end(), 0.0);
        };
        EXPECT_NEAR(sum(samples(1e-3f)), sum(bright), 0.05 * sum(bright)) << integrator;
    }
}

// A lamp that paths meet by chance only, once in 800 samples: after 48 samples 19 of 20 pixels are black.
TEST(RelativeError, WaitsForLightThatComesSeldom) {
    SceneDesc scene = empty_scene();
    add_object(scene, quad({0, 0, -1}, {2, 0, 0}, {0, 2, 0}), add_material(scene, diffuse(Rgb(0.5f))));
    add_object(scene, quad({0, 0, 0.01f}, {0.03f, 0, 0}, {0, -0.03f, 0}), add_material(scene, emissive(Rgb(8.0f))));
    const World world = compile(scene);
    const auto mean = [](const Film& film) {
        double sum = 0.0;
        for (const PixelSum& p : film.sums()) sum += p.r / p.weight / static_cast<double>(film.sums().size());
        return sum;
    };
    const double expected = mean(render_now(world, "path", options_for(16, 16, 64), 2).film);
    RenderOptions options = options_for(16, 16, 1u << 20);
    for (const bool adaptive : {false, true}) {
        options.relative_error = 0.3;
        options.adaptive = adaptive;
        const RenderResult result = render_with_estimate(world, "naive", options);
        EXPECT_EQ(result.halt_reason, HaltReason::ErrorReached);
        // 1 / 0.3² hits in each of 256 pixels: four deviations of their sum are 8%.
        EXPECT_NEAR(mean(result.film), expected, 0.08 * expected) << adaptive;
    }
}

TEST(RelativeError, ABlackImageEndsAfterAWhile) {
    const World world = compile(empty_scene());
    RenderOptions options = options_for(16, 16, 1u << 20);
    options.relative_error = 0.1;
    for (const char* integrator : {"path", "bdpt", "light"}) {
        const RenderResult result = render_with_estimate(world, integrator, options);
        EXPECT_EQ(result.halt_reason, HaltReason::ErrorReached) << integrator;
        EXPECT_GE(result.spp_done, 100u) << integrator << ": 1 / 0.1²";
        EXPECT_LE(result.spp_done, 116u) << integrator << ": no more than a pass beyond";
    }
}

}  // namespace

}  // namespace etendue::test
