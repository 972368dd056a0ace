// Strategies alone: each that can make all paths of a length makes the same image of them, and with their weights they
// add up to the whole.
#include "integrator/agreement_cases.h"
#include "integrator/bdpt/bdpt_integrator.h"
#include "render/render.h"

#include <atomic>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr int kEdges = 3;

/// A room without mirrors, in which every strategy can make every path.
World room() {
    for (const AgreementCase& agreement : agreement_cases())
        if (agreement.name == "LampDiffuse") return agreement_world(agreement);
    ADD_FAILURE() << "no such room";
    return agreement_world(agreement_cases().front());
}

/// Mean of all channels and pixels; of paths of `kEdges` edges.
double mean_image(const World& world, std::optional<Strategy> only, bool weighted, std::uint32_t seed) {
    const ThreadPool threads;
    const std::atomic<bool> stop{false};
    BdptOptions options;
    options.lengths = {.max_depth = kEdges, .min_depth = kEdges};
    options.only = only;
    options.weighted = weighted;
    RenderOptions render_options;
    render_options.full_width = kAgreementWidth;
    render_options.full_height = kAgreementHeight;
    render_options.window = {0, 0, kAgreementWidth, kAgreementHeight};
    render_options.spp = 64;
    render_options.seed = seed;
    const std::vector<float> rgba =
        render(world, BdptIntegrator(options), render_options, threads, stop, {}).film.resolve();
    double sum = 0.0;
    for (std::size_t i = 0; i < rgba.size(); ++i)
        if (i % 4 != 3) sum += static_cast<double>(rgba[i]);
    return sum / static_cast<double>(rgba.size() / 4 * 3);
}

// Seeds are fixed. Four independent images per strategy: the limit is five standard errors, and each is below 2%.
TEST(BdptStrategies, EachAloneMakesTheSameImage) {
    const World world = room();
    const double expected = mean_image(world, std::nullopt, true, 100);
    for (int s = 0; s <= kEdges; ++s) {
        constexpr int kSeeds = 4;
        double sum = 0.0;
        double squares = 0.0;
        for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
            const double mean = mean_image(world, Strategy{s, kEdges + 1 - s}, false, seed);
            sum += mean;
            squares += mean * mean;
        }
        const double mean = sum / kSeeds;
        const double error = std::sqrt(std::max(0.0, squares / kSeeds - mean * mean) / (kSeeds - 1));
        EXPECT_LE(error, 0.02 * expected) << "s = " << s;
        EXPECT_NEAR(mean, expected, 5.0 * error + 0.003 * expected) << "s = " << s;
    }
}

// The same random numbers: what one strategy finds does not depend on whether others are asked for.
TEST(BdptStrategies, WeightedOnesAddUpToTheWhole) {
    const World world = room();
    double sum = 0.0;
    for (int s = 0; s <= kEdges; ++s) sum += mean_image(world, Strategy{s, kEdges + 1 - s}, true, 7);
    EXPECT_NEAR(sum / mean_image(world, std::nullopt, true, 7), 1.0, 1e-5);
}

}  // namespace

}  // namespace etendue::test
