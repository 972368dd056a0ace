// A render that is stopped again and again, anywhere, and gone on with by any number of threads.
#include "render/render.h"
#include "render/render_test_scene.h"
#include "render/tiles.h"

#include <atomic>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

/// Renders until `questions` tiles, or groups of them, have asked whether to stop. False if it came to the end.
bool render_part(const World& world, const Integrator& integrator, const RenderOptions& options, int threads,
                 int questions, RenderState& state) {
    const ThreadPool pool(threads);
    std::atomic<int> asked = 0;
    ProgressiveRender rendering(world, integrator, options, pool, std::move(state));
    const auto stop = [&] { return ++asked > questions; };
    bool done = true;
    while (done && rendering.state().spp_done < options.spp)
        done = rendering.add_samples(pass_size(rendering.state().spp_done, options.spp), stop);
    state = rendering.take_state();
    return !done;
}

class Resume : public testing::TestWithParam<std::string> {};

TEST_P(Resume, EndsWithTheSameBytes) {
    const World world = compile(busy_scene(100, 70));
    const auto integrator = make_integrator(GetParam(), {});
    RenderOptions options = options_for(100, 70, 9);
    options.window = {3, 5, 97, 70};
    const RenderResult whole = render_now(world, GetParam().c_str(), options, 2);
    std::mt19937 random(7);
    for (int attempt = 0; attempt < 2; ++attempt) {
        RenderState state{.film = Film(options.full_width, options.full_height, options.window)};
        int stops = 0;
        while (render_part(world, *integrator, options, 1 + static_cast<int>(random() % 3),
                           static_cast<int>(random() % 3), state)) {
            ++stops;
            EXPECT_EQ(state.film.sample_count(), state.counters.samples);
        }
        EXPECT_GE(stops, 3);
        EXPECT_EQ(state.spp_done, options.spp);
        EXPECT_EQ(state.counters.samples, whole.counters.samples);
        EXPECT_EQ(state.counters.rays.total(), whole.counters.rays.total());
        EXPECT_TRUE(same_bytes(state.film.resolve(), whole.film.resolve())) << "after " << stops << " stops";
    }
}

INSTANTIATE_TEST_SUITE_P(Integrators, Resume, testing::Values("path", "light", "bdpt", "vcm"),
                         [](const auto& test) { return test.param; });

TEST(RenderPause, ActsInTheMiddleAndChangesNothing) {
    const World world = compile(busy_scene(96, 96));
    const auto integrator = make_integrator("bdpt", {});
    const RenderOptions options = options_for(96, 96, 6);
    const ThreadPool pool(2);
    const std::atomic<bool> stop{false};
    std::atomic<int> asked = 0;
    std::vector<std::uint64_t> seen;
    const RenderPause pause{.is_due = [&] { return ++asked % 3 == 0; },
                            .act = [&](const RenderState& state) { seen.push_back(state.film.sample_count()); }};
    const RenderResult result =
        render(world, *integrator, options, pool, stop, {}, pause, {.film = Film(96, 96, options.window)});
    EXPECT_EQ(result.halt_reason, HaltReason::SamplesDone);
    EXPECT_TRUE(same_bytes(result.film.resolve(), render_now(world, "bdpt", options, 2).film.resolve()));
    ASSERT_GE(seen.size(), 2u);
    for (std::size_t i = 1; i < seen.size(); ++i) EXPECT_GE(seen[i], seen[i - 1]);
    EXPECT_LT(seen.front(), result.counters.samples);
}

/// Stops in the middle of the pass that begins with sample 2.
RenderState stopped_in_a_pass(const World& world, const Integrator& integrator, const RenderOptions& options) {
    const ThreadPool pool(1);
    int asked = 0;
    ProgressiveRender rendering(world, integrator, options, pool);
    for (const std::uint32_t count : {1u, 1u}) rendering.add_samples(count, [] { return false; });
    rendering.add_samples(2, [&] { return ++asked > 4; });
    EXPECT_EQ(rendering.state().pass_size, 2u);
    EXPECT_GT(rendering.state().film.sample_count(), options.window.area() * 2) << "no tile of the pass was rendered";
    return rendering.take_state();
}

TEST(RenderPause, TheLimitOfTimeWaitsForTheEndOfThePass) {
    const World world = compile(busy_scene(96, 96));
    const auto integrator = make_integrator("path", {});
    RenderOptions options = options_for(96, 96, 64);
    options.time_limit_seconds = 1e-9;
    const ThreadPool pool(1);
    const std::atomic<bool> stop{false};
    int asked = 0;
    const RenderPause pause{.is_due = [&] { return ++asked == 5; }, .act = [](const RenderState&) {}};
    const RenderResult result =
        render(world, *integrator, options, pool, stop, {}, pause, {.film = make_film(options)});
    EXPECT_GT(asked, 5);
    EXPECT_EQ(result.halt_reason, HaltReason::TimeLimit);
    EXPECT_EQ(result.spp_done, 1u);
    EXPECT_EQ(result.pass_size, 0u);
    EXPECT_EQ(result.film.sample_count(), options.window.area());
}

TEST(ResumedRender, ALimitOfTimeThatIsOverWaitsForTheEndOfThePass) {
    const World world = compile(busy_scene(96, 96));
    const auto integrator = make_integrator("path", {});
    RenderOptions options = options_for(96, 96, 64);
    RenderState state = stopped_in_a_pass(world, *integrator, options);
    options.time_limit_seconds = 0.5 * state.wall_seconds;
    const ThreadPool pool(2);
    const std::atomic<bool> stop{false};
    const RenderResult result = render(world, *integrator, options, pool, stop, {}, {}, std::move(state));
    EXPECT_EQ(result.halt_reason, HaltReason::TimeLimit);
    EXPECT_EQ(result.spp_done, 4u);
    EXPECT_EQ(result.film.sample_count(), options.window.area() * 4);
}

TEST(ResumedRender, FinishesThePassIfFewerSamplesAreAskedForNow) {
    const World world = compile(busy_scene(96, 96));
    const auto integrator = make_integrator("path", {});
    for (const std::uint32_t spp : {1u, 2u, 3u, 4u}) {
        const RenderOptions options = options_for(96, 96, spp);
        const ThreadPool pool(2);
        const std::atomic<bool> stop{false};
        const RenderResult result =
            render(world, *integrator, options, pool, stop, {}, {}, stopped_in_a_pass(world, *integrator, options));
        EXPECT_EQ(result.halt_reason, HaltReason::SamplesDone);
        EXPECT_EQ(result.spp_done, 4u) << spp;
        EXPECT_EQ(result.pass_size, 0u);
        const RenderResult whole = render_now(world, "path", options_for(96, 96, 4), 2);
        EXPECT_TRUE(same_bytes(result.film.resolve(), whole.film.resolve())) << spp;
    }
}

}  // namespace

}  // namespace etendue::test
