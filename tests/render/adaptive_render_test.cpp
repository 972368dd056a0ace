// Adaptive renders: whether they end at their error, are the same however they are rendered, and are not biased.
#include "render/adaptive_pass.h"
#include "render/checkpoint.h"
#include "render/render.h"
#include "render/render_test_scene.h"
#include "support/temporary_folder.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

RenderOptions adaptive_options(int width, int height, double error, std::uint32_t spp = 4096) {
    RenderOptions options = options_for(width, height, spp);
    options.relative_error = error;
    options.adaptive = true;
    return options;
}

RenderState with_halves(const RenderOptions& options) {
    RenderState state{.film = make_film(options)};
    state.every_other_pass = make_film(options);
    return state;
}

RenderResult render_all(const World& world, const std::string& integrator, const RenderOptions& options,
                        int threads = 2) {
    const ThreadPool pool(threads);
    const std::atomic<bool> never{false};
    return render(world, *make_integrator(integrator, {}), options, pool, never, {}, {}, with_halves(options));
}

class AdaptiveRender : public testing::TestWithParam<std::string> {};

TEST_P(AdaptiveRender, EndsAtTheErrorWithDifferentNumbersOfSamples) {
    const World world = compile(busy_scene(80, 50));
    RenderOptions options = adaptive_options(80, 50, 0.045);
    const RenderResult result = render_all(world, GetParam(), options);
    EXPECT_EQ(result.halt_reason, HaltReason::ErrorReached);
    EXPECT_LE(*relative_error(result), options.relative_error);
    const std::vector<std::uint32_t>& samples = result.adaptive.samples;
    ASSERT_EQ(samples.size(), options.window.area());
    const auto [least, most] = std::ranges::minmax(samples);
    EXPECT_EQ(least, result.spp_done);
    EXPECT_GE(least, 48u);
    EXPECT_GE(most, 2 * least);
    // What is said of each pixel is what the film has.
    for (std::size_t p = 0; p < samples.size(); ++p) EXPECT_EQ(result.film.sums()[p].samples, samples[p]) << p;
    EXPECT_EQ(result.film.sample_count(), result.counters.samples);
    for (std::size_t p = 0; p < samples.size(); ++p) {
        const std::uint64_t half = result.every_other_pass->sums()[p].samples;
        EXPECT_GE(3 * half, samples[p]) << "a third at least, " << p;
        EXPECT_LE(3 * half, 2 * samples[p]) << "two thirds at most, " << p;
    }
}

TEST_P(AdaptiveRender, BeginsWithTheSmallestNumberOfSamples) {
    const World world = compile(busy_scene(80, 50));
    RenderOptions options = adaptive_options(80, 50, 0.045);
    options.min_spp = 100;
    EXPECT_GE(render_all(world, GetParam(), options).spp_done, 112u);
}

TEST_P(AdaptiveRender, NoPixelGetsMoreThanTheMost) {
    const World world = compile(busy_scene(40, 25));
    RenderOptions options = adaptive_options(40, 25, 1e-4, 85);
    const RenderResult result = render_all(world, GetParam(), options);
    EXPECT_EQ(result.halt_reason, HaltReason::SamplesDone);
    EXPECT_EQ(std::ranges::max(result.adaptive.samples), 85u);
    EXPECT_EQ(result.spp_done, 85u) << "an error out of reach takes all of them";
}

TEST_P(AdaptiveRender, IsTheSameForAnyThreadsAndOrderAndStops) {
    const TemporaryFolder folder;
    const World world = compile(busy_scene(80, 50));
    const auto integrator = make_integrator(GetParam(), {});
    RenderOptions options = adaptive_options(80, 50, 0.045, 512);
    options.window = {3, 5, 80, 50};
    const RenderResult whole = render_all(world, GetParam(), options, 1);
    ASSERT_FALSE(whole.adaptive.is_uniform());
    options.tile_order_seed = 9;
    EXPECT_TRUE(same_bytes(whole.film.resolve(), render_all(world, GetParam(), options, 3).film.resolve()));
    std::mt19937 random(7);
    RenderState state = with_halves(options);
    int stops_inside = 0;
    for (int stops = 0; stops < 1000; ++stops) {
        // Between two questions a whole pass of bdpt may go by: it is stopped at its first, too.
        const ThreadPool pool(1 + static_cast<int>(random() % 3));
        std::atomic<bool> stop{false};
        std::atomic<int> asked = 0;
        const int questions = static_cast<int>(random() % 5);
        const RenderPause pause{.is_due =
                                    [&] {
                                        if (++asked > questions) stop = true;
                                        return false;
                                    },
                                .act = [](const RenderState&) {}};
        RenderResult part = render(world, *integrator, options, pool, stop, {}, pause, std::move(state));
        if (part.halt_reason != HaltReason::Interrupted) {
            EXPECT_TRUE(same_bytes(whole.film.resolve(), part.film.resolve())) << "after " << stops << " stops";
            EXPECT_EQ(part.counters.samples, whole.counters.samples);
            EXPECT_EQ(part.adaptive.samples, whole.adaptive.samples);
            EXPECT_EQ(part.halt_reason, whole.halt_reason);
            EXPECT_GE(stops_inside, 2) << "stops inside an adaptive pass";
            return;
        }
        stops_inside += !part.adaptive.is_active.empty();
        write_checkpoint(folder / "a.checkpoint", {}, "", part);
        state = read_checkpoint(folder / "a.checkpoint").state;
    }
    FAIL() << "it does not end";
}

INSTANTIATE_TEST_SUITE_P(Integrators, AdaptiveRender, testing::Values("path", "bdpt"),
                         [](const auto& test) { return test.param; });

// Samples that merge make passes of their own, but the error is estimated only where the usual passes end.
TEST(AdaptiveVcm, APauseBetweenSamplesThatMergeDecidesNothing) {
    const World world = compile(busy_scene(40, 25));
    const auto integrator = make_integrator("vcm", {});
    const RenderOptions options = adaptive_options(40, 25, 10.0, 512);
    const ThreadPool pool(1);
    const std::atomic<bool> stop{false};
    int asked = 0;
    const RenderPause pause{.is_due = [&] { return ++asked % 3 == 0; }, .act = [](const RenderState&) {}};
    const RenderResult paused = render(world, *integrator, options, pool, stop, {}, pause, with_halves(options));
    const RenderResult whole = render_all(world, "vcm", options, 1);
    EXPECT_EQ(paused.halt_reason, HaltReason::ErrorReached);
    EXPECT_EQ(paused.spp_done, whole.spp_done);
    EXPECT_TRUE(same_bytes(paused.film.resolve(), whole.film.resolve()));
}

// There is nothing to choose between pixels.
TEST(AdaptiveLight, IsUniform) {
    const World world = compile(busy_scene(40, 25));
    const RenderResult result = render_all(world, "light", adaptive_options(40, 25, 0.1, 1024));
    ASSERT_FALSE(result.adaptive.is_uniform());
    EXPECT_EQ(std::ranges::max(result.adaptive.samples), result.spp_done);
    EXPECT_EQ(result.halt_reason, HaltReason::ErrorReached);
}

// Light paths of a few pixels make a light image that is as bright as that of all.
TEST(AdaptiveLight, IsDividedByThePathsThatWereTraced) {
    const World world = compile(busy_scene(40, 25));
    const auto integrator = make_integrator("light", {});
    RenderOptions options = options_for(40, 25, 1);
    const ThreadPool pool(2);
    const StopPredicate never = [] { return false; };
    ProgressiveRender rendering(world, *integrator, options, pool);
    rendering.add_samples(256, never);
    std::vector<std::uint8_t> few(options.window.area(), 0);
    for (std::size_t p = 0; p < few.size(); p += 7) few[p] = 1;
    const auto active = static_cast<std::uint64_t>(std::ranges::count(few, 1));
    rendering.add_samples_to(few, 4096, never);
    const RenderState& state = rendering.state();
    EXPECT_EQ(state.film.light_paths(), options.window.area() * 256 + active * 4096);
    const auto mean = [](const std::vector<float>& image) {
        double sum = 0.0;
        for (std::size_t i = 0; i < image.size(); ++i)
            if (i % 4 != 3) sum += static_cast<double>(image[i]);
        return sum / static_cast<double>(image.size());
    };
    options.spp = 1024;
    options.seed = 6;
    const double expected = mean(render_now(world, "light", options, 2).film.resolve());
    EXPECT_NEAR(mean(state.film.resolve()), expected, 0.02 * expected);
}

}  // namespace

}  // namespace etendue::test
