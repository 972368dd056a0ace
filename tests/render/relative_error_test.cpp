// When a render ends for the error that its image has, and whether that error is what is said.
#include "render/render.h"
#include "render/render_test_scene.h"

#include <atomic>
#include <cmath>
#include <cstdint>
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

/// The square root of relMSE, as `etendue diff` has it.
double measured_error(const std::vector<float>& image, const std::vector<float>& reference) {
    double sum = 0.0;
    for (std::size_t i = 0; i < image.size(); ++i) {
        if (i % 4 == 3) continue;  // alpha
        const auto truth = static_cast<double>(reference[i]);
        sum += std::pow(static_cast<double>(image[i]) - truth, 2.0) / (truth * truth + 0.01);
    }
    return std::sqrt(sum / (0.75 * static_cast<double>(image.size())));
}

// Splats: what light subpaths leave depends on the passes, and on nothing that pixels alone know. Rare bright ones that
// have not come yet are missing in both parts, so that the estimate is too low rather than too high: by 4% here, and by
// 13% after 48 samples per pixel.
TEST(RelativeError, IsThatOfALongReferenceForLightSubpaths) {
    constexpr std::uint32_t kSeeds = 4;
    const World world = compile(busy_scene(40, 25));
    RenderOptions options = options_for(40, 25, 4096);
    options.sequence = SampleSequence::Random;
    options.seed = 99;
    const std::vector<float> reference = render_now(world, "light", options, 2).film.resolve();
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

}  // namespace

}  // namespace etendue::test
