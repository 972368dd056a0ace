#include "integrator/pilot.h"

#include "core/parallel.h"
#include "loader/loader.h"
#include "picture/integrator_choice.h"
#include "render/render.h"
#include "world/compile.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <utility>

#include <gtest/gtest.h>

namespace etendue {
namespace {

struct PilotScene {
    RenderSettings settings;
    World world;
};

PilotScene pilot_scene(const std::string& name, const ThreadPool& threads) {
    SceneDesc desc = load_scene(std::filesystem::path(ETENDUE_SCENES) / name).scene;
    RenderSettings settings = desc.settings;
    ProblemList warnings;
    return {std::move(settings), compile_world(std::move(desc), ColorConfig::built_in(), "ACEScg", threads, warnings)};
}

std::string chosen_for(const std::string& name) {
    const ThreadPool threads;
    const PilotScene scene = pilot_scene(name, threads);
    return choose_integrator(scene.world, scene.settings, integrators_to_choose(scene.settings), threads).integrator;
}

TEST(Pilot, ChoosesWhatIsQuickest) {
    EXPECT_EQ(chosen_for("veach-mis"), "path");
    EXPECT_EQ(chosen_for("sun-and-sky"), "path");
    EXPECT_EQ(chosen_for("ajar-door"), "bdpt");
    EXPECT_EQ(chosen_for("caustic-mirror"), "bdpt");
    EXPECT_EQ(chosen_for("caustic-pool"), "vcm");
    EXPECT_EQ(chosen_for("torus-in-glass"), "vcm");
}

TEST(Pilot, FindsTheSameWithAnyNumberOfThreads) {
    const ThreadPool one(1);
    const ThreadPool three(3);
    const PilotScene scene = pilot_scene("caustic-pool", one);
    const auto findings = [&](const ThreadPool& threads) {
        return run_pilot(scene.world, scene.settings.integrator, 480, 270, threads);
    };
    const PilotFindings a = findings(one);
    const PilotFindings b = findings(three);
    EXPECT_EQ(a.errors, b.errors);
    EXPECT_EQ(a.costs, b.costs);
}

/// Returns the mean squared relative error of a sample per pixel, from the difference of two renders.
double measured_error(const PilotScene& scene, const std::string& integrator, const ThreadPool& threads) {
    constexpr int kSide = 64;
    constexpr std::uint32_t kSamples = 48;
    RenderOptions options;
    options.full_width = options.full_height = kSide;
    options.window = {0, 0, kSide, kSide};
    options.spp = kSamples;
    options.sequence = SampleSequence::Random;
    options.filter = PixelFilter(FilterShape::Box);
    const auto image = [&](std::uint32_t seed) {
        options.seed = seed;
        const std::atomic<bool> stop = false;
        return rgba_image(
            render(scene.world, *make_integrator(integrator, scene.settings.integrator), options, threads, stop, {})
                .film);
    };
    const ImageF a = image(1);
    const ImageF b = image(2);
    double sum = 0.0;
    for (std::size_t i = 0; i < a.pixels.size(); i += 4) {
        const auto mean = [&](const ImageF& of) {
            return (static_cast<double>(of.pixels[i]) + static_cast<double>(of.pixels[i + 1]) +
                    static_cast<double>(of.pixels[i + 2])) /
                   3.0;
        };
        const double light = 0.5 * (mean(a) + mean(b));
        const double apart = mean(a) - mean(b);
        sum += 0.5 * apart * apart / (light * light + 0.01);
    }
    return sum / (kSide * kSide) * kSamples;
}

// Within 35%: the pilot's errors are from four samples a pixel, and vary by 10% from seed to seed.
TEST(Pilot, TellsTheErrorsOfRenders) {
    const ThreadPool threads;
    const PilotScene scene = pilot_scene("cornell-box", threads);
    IntegratorSettings settings = scene.settings.integrator;
    settings.lamp_images = false;
    const PilotFindings findings = run_pilot(scene.world, settings, 256, 256, threads);
    for (std::size_t i = 0; i < 2; ++i) {
        const double measured = measured_error(scene, std::string(kComparedNames.at(i)), threads);
        EXPECT_GT(findings.errors.at(i), 0.65 * measured) << kComparedNames.at(i);
        EXPECT_LT(findings.errors.at(i), 1.35 * measured) << kComparedNames.at(i);
    }
}

VarianceSum variances(std::initializer_list<double> estimates) {
    VarianceSum sum;
    for (const double estimate : estimates) sum.add(estimate);
    return sum;
}

TEST(VarianceSum, IsTheMeanUnlessThatCannotBeToldFromNothing) {
    const VarianceSum usual = variances({1.0, 0.0, 5.0, 0.0});
    EXPECT_TRUE(usual.is_told());
    EXPECT_EQ(usual.mean(4.0), 1.5);
    const VarianceSum alone = variances({0.0, 3.0, 0.0});
    EXPECT_TRUE(alone.is_told());
    EXPECT_EQ(alone.mean(3.0), 1.0);
    for (const VarianceSum& lost : {variances({3.0, -4.0}), variances({4.0, -3.0})}) {
        EXPECT_FALSE(lost.is_told());
        EXPECT_EQ(lost.mean(2.0), 2.5);
    }
    EXPECT_FALSE(VarianceSum().is_told());
}

IntegratorChoice choose_of_all(const PerIntegrator<double>& errors, const PerIntegrator<bool>& is_told) {
    return choose_by({.errors = errors, .is_told = is_told, .costs = {1.0, 2.0, 3.0}}, {0, 1, 2});
}

TEST(IntegratorChoice, TakesTheSimplestOfWhatCannotBeTold) {
    const IntegratorChoice none = choose_of_all({4.0, 0.1, 0.01}, {false, false, false});
    EXPECT_EQ(none.integrator, "path");
    EXPECT_EQ(none.reason, "'path': a pilot's few samples tell too little of the noise of 'path' and 'bdpt' and 'vcm'");
    const IntegratorChoice told = choose_of_all({1.0, 4.0, 2.0}, {true, true, true});
    EXPECT_EQ(told.reason, "'path': for as little noise 'bdpt' takes 8.0 times and 'vcm' takes 6.0 times as long");
    const IntegratorChoice one = choose_of_all({1.0, 4.0, 0.5}, {true, true, false});
    EXPECT_EQ(one.integrator, "path");
    EXPECT_EQ(one.reason,
              "'path': for as little noise 'bdpt' takes 8.0 times as long; a pilot's few samples tell too "
              "little of the noise of 'vcm'");
    // At most so noisy: a bound is enough where it is far below.
    const IntegratorChoice bounded = choose_of_all({1.0, 4.0, 0.01}, {true, true, false});
    EXPECT_EQ(bounded.integrator, "vcm");
    EXPECT_EQ(bounded.reason,
              "'vcm': for as little noise 'path' takes at least 33 times and 'bdpt' takes at least 267 "
              "times as long; a pilot's few samples tell too little of the noise of 'vcm'");
}

}  // namespace
}  // namespace etendue
