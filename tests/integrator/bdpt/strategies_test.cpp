// Strategies alone: each that can make all paths of a length makes the same image of them, and with their weights they
// add up to the whole.
#include "integrator/bdpt/render_bdpt.h"

#include <cstdint>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr int kEdges = 3;

/// A room without mirrors, in which every strategy can make every path.
World room() {
    return agreement_world(agreement_case("LampDiffuse"));
}

/// Mean of all channels and pixels; of paths of `kEdges` edges.
double mean_image(const World& world, std::optional<Strategy> only, bool weighted, std::uint32_t seed) {
    IntegratorSettings options;
    options.lengths = {.max_depth = kEdges, .min_depth = kEdges};
    options.strategy = only;
    options.weighted = weighted;
    return mean_of(render_bdpt(world, options, 64, seed));
}

// Seeds are fixed. Four independent images per strategy: the limit is five standard errors, and each is below 2%.
TEST(BdptStrategies, EachAloneMakesTheSameImage) {
    const World world = room();
    const double expected = mean_image(world, std::nullopt, true, 100);
    for (int s = 0; s <= kEdges; ++s) {
        constexpr int kSeeds = 4;
        std::vector<double> means;
        for (std::uint32_t seed = 1; seed <= kSeeds; ++seed)
            means.push_back(mean_image(world, Strategy{s, kEdges + 1 - s}, false, seed));
        const MeanEstimate estimate(means);
        EXPECT_LE(estimate.error, 0.02 * expected) << "s = " << s;
        EXPECT_NEAR(estimate.mean, expected, 5.0 * estimate.error + 0.003 * expected) << "s = " << s;
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
